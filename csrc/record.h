/* record.h - inside the core: what is kept of a step: channels, bearings that run off their shoulders. */
#ifndef BD_RECORD_H
#define BD_RECORD_H

#include "work.h"

/* One value per channel of the state, whose bearings were evaluated last. */
void bd_record_row(const bd_model *model, const bd_work *work, bd_state *state, double *row);

/* Counts a step in which a bearing runs off its shoulder; the first of them is kept. */
void bd_count_open_sides(const bd_model *model, const bd_work *work, double t, bd_report *report);

#endif
