// What the sandbox really binds, in the words of the API's table.
#include <algorithm>

#include "api.h"
#include "script/check/known_names.h"
#include "script/host/silent_log.h"

namespace kadans {

std::vector<std::string> bound_names(const std::filesystem::path& root, const std::filesystem::path& behavior,
                                     const Catalog& catalog) {
  SilentLog silence;
  Behavior::Parts parts({.root = root, .file = behavior}, catalog, silence);
  load_behavior(parts, parts.settings.limits.load_instructions);
  KnownNames known = read_known_names(parts);
  std::vector<std::string> all;
  const auto add = [&](const std::string& owner, const std::vector<std::string>& names) {
    for (const std::string& name : names) all.push_back(std::string(owner).append(".").append(name));
  };
  for (const ObjectInfo& object : catalog.objects) known.machine.fields.erase(object.name);
  auto& s = known.snapshot.fields;
  add("log", known.module.fields["log"].names());
  add("kadans", known.module.names());
  add("m", known.machine.names());
  add("object", known.object_methods);
  add("motion", known.motion_fields);
  add("s", known.snapshot.names());
  add("joint", s["joints"].fields.begin()->second.names());
  add("base", s["base"].names());
  add("rate", s["base"].fields["angular_velocity_rad_s"].names());
  add("foot", s["feet"].fields["left"].names());
  add("support", s["support"].names());
  add("safety", s["safety"].names());
  add("joystick", s["joystick"].names());
  std::sort(all.begin(), all.end());
  return all;
}

}  // namespace kadans
