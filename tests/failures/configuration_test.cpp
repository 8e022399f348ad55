// Every fault names a key of the configuration that there is.
#include <algorithm>
#include <string>

#include <doctest/doctest.h>

#include "kadans/config/robot_config.h"
#include "kadans/signal/fault.h"

using namespace kadans;

namespace {

const FieldInfo* field(const FieldInfo& in, const std::string& name) {
  // The elements of a map are described once, whatever their keys.
  const FieldInfo& holder = in.kind == FieldInfo::Kind::map ? in.fields.at(0) : in;
  const auto found =
      std::find_if(holder.fields.begin(), holder.fields.end(), [&](const FieldInfo& f) { return f.name == name; });
  return found == holder.fields.end() ? nullptr : &*found;
}

}  // namespace

TEST_CASE("The configuration key behind every fault is a key of the robot's configuration") {
  const FieldInfo robot = describe_robot_config();
  for (std::size_t code = 1; code < fault_codes; ++code) {
    std::string key = configuration_key(static_cast<FaultCode>(code));
    CAPTURE(key);
    const FieldInfo* at = &robot;
    while (at != nullptr && !key.empty()) {
      const std::size_t dot = key.find('.');
      at = field(*at, key.substr(0, dot));
      key = dot == std::string::npos ? "" : key.substr(dot + 1);
    }
    CHECK(at != nullptr);
  }
}
