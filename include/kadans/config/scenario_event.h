// What happens in a scenario at a time given beforehand, so that the run repeats: orders of the supervisor, and
// behaviors that go on with another file as if somebody had saved it.
#pragma once

#include "kadans/config/fields.h"
#include "kadans/config/play_order.h"

namespace kadans {

struct ScenarioEvent {
  double at_s = 0;
  PlayOrder order;
};

// The fields of one event. Lists are read with the folders; a reload's behavior is for whoever knows the names.
void event_fields(Fields& f, ScenarioEvent& event, const PlayFolders& folders, Problems& problems);

}  // namespace kadans
