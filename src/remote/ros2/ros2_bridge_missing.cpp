// In place of the bridge where Cyclone DDS was not found.
#include "kadans/signal/input_error.h"
#include "ros2_bridge.h"

namespace kadans {

struct Ros2Bridge::Inside {};

Ros2Bridge::Ros2Bridge(const Ros2Settings&, const Parts&) {
  throw InputError(InputProblem{.file = "--ros2",
                                .message = "this program was built without it: apt-get install cyclonedds-dev "
                                           "cyclonedds-tools, and build it again"});
}

Ros2Bridge::~Ros2Bridge() = default;
void Ros2Bridge::start() noexcept {}
void Ros2Bridge::stop() noexcept {}

}  // namespace kadans
