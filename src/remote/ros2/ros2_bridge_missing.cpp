// In place of the bridge where Cyclone DDS was not found.
#include "ros2_bridge.h"
#include "signal/input_file.h"

namespace kadans {

struct Ros2Bridge::Inside {};

Ros2Bridge::Ros2Bridge(const Ros2Settings&, const Parts&) {
  refuse("--ros2",
         "this program was built without it: apt-get install cyclonedds-dev cyclonedds-tools, and build it again");
}

Ros2Bridge::~Ros2Bridge() = default;
void Ros2Bridge::start() noexcept {}
void Ros2Bridge::stop() noexcept {}

}  // namespace kadans
