// Files that clients may ask for: the robot's URDF, and exactly the meshes that it names, of at most 16 MB.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "kadans/remote/robot_texts.h"

namespace kadans {

class LiveAssets {
 public:
  LiveAssets(const RobotTexts& texts, const std::string& urdf_file);

  // "package://tulip/tulip.urdf", "robot.urdf", or a mesh as the URDF names it, also without "package://". Reads the
  // file; none: no such asset, or it cannot be read.
  std::optional<std::string> read(std::string_view uri) const;

 private:
  std::string urdf_, urdf_uri_;
  std::map<std::string, std::string, std::less<>> files_;  // by name in the URDF
};

}  // namespace kadans
