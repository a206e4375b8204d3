/* closing.h - inside the core: balls that are about to come into contact or to leave it, or have just done so. */
#ifndef BD_CLOSING_H
#define BD_CLOSING_H

#include "bearing.h"

/* Where a contact opens or closes its force has a kink or a jump, which samples meet at random. Every ball within some
 * windows of it, s = delta + h0 running through at its present rate, gets what the samples' sum should see instead:
 * forces are then smooth in z. */
void bd_soften_edges(const bd_bearing_data *data, double window, bd_bearing_work *work,
                     size_t coefs, double *g);

#endif
