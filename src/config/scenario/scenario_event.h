// An event of a scenario: an order of the supervisor at a given time, so that the run can be repeated. A reload lets a
// behavior continue with another file, as if somebody had saved it.
#pragma once

#include "config/json/fields.h"
#include "play_order.h"

namespace kadans {

struct ScenarioEvent {
  double at_s = 0;
  PlayOrder order;
};

// The fields of one event. `folders` are used to find the behaviors of a list. The name of a reload's behavior is not
// checked here, because the names are known only when the behaviors play.
void event_fields(Fields& f, ScenarioEvent& event, const PlayFolders& folders, Problems& problems);

}  // namespace kadans
