// The signals of joint states and robot status, under the names by which recorder, checks, viewers and scripts know
// them: the fields of signal/status_fields.h under joint.NAME, base, foot.LINK and support.
#pragma once

#include "kadans/model/robot_model.h"
#include "kadans/signal/signal.h"
#include "kadans/signal/status.h"
#include "settings.h"

namespace kadans {

// Before the loop. The snapshot is what Estimator::update fills; it must outlive the table's use. Throws
// std::invalid_argument on a name that is taken.
void declare_signals(SignalTable& table, const RobotModel& model, const EstimateSettings& settings,
                     const Snapshot& snapshot);

}  // namespace kadans
