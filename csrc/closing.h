/* closing.h - inside the core: balls whose damper is about to close or has just closed. */
#ifndef BD_CLOSING_H
#define BD_CLOSING_H

#include "bearing.h"

/* Where a film closes its damper makes the force jump from 0 to c times the rate. Every ball within two windows of it,
 * as s = delta + h0 runs through zero at its present rate, gets its share of the jump instead: forces are then
 * continuous in z. */
void bd_soften_closing(const bd_bearing_data *data, double window, bd_bearing_work *work,
                       size_t coefs, double *g);

#endif
