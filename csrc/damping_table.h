/* damping_table.h - inside the core: the damping of a contact from a table. */
#ifndef BD_DAMPING_TABLE_H
#define BD_DAMPING_TABLE_H

#include "bearingdyn.h"

/* c(delta) and its slope from a table, ends held. */
static inline double bd_table_damping(const bd_contact *contact, double delta, double *slope)
{
    const double *x = contact->table_delta, *c = contact->table_c;
    int last = contact->n_table - 1;
    *slope = 0.0;
    if (!(delta > x[0])) /* NaN too, lest the search below run off the table */
        return c[0];
    if (delta >= x[last])
        return c[last];
    int i = 0;
    while (delta > x[i + 1])
        i++;
    *slope = (c[i + 1] - c[i]) / (x[i + 1] - x[i]);
    return c[i] + *slope * (delta - x[i]);
}

#endif
