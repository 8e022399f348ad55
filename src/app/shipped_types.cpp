#include "shipped_types.h"

#include "kadans/control/joint_pid.h"

namespace kadans {

// A line a type: the "type" of a robot's configuration, and what makes it.
void add_shipped_types(ControlObjectTypes& types) {
  types.add("joint_pid", make_joint_pid);
}

}  // namespace kadans
