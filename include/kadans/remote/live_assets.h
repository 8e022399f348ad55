// Files that clients may ask for: the robot's URDF, and exactly the meshes that it names, of at most 16 MB.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "kadans/remote/robot_texts.h"

namespace kadans {

class LiveAssets {
 public:
  LiveAssets(const RobotTexts& texts, const std::string& urdf_file);

  using Content = std::shared_ptr<const std::string>;
  // "package://tulip/tulip.urdf", "robot.urdf", or a mesh as the URDF names it, also without "package://". Reads the
  // file, once for all who hold its content at a time; null: no such asset, or it cannot be read.
  Content read(std::string_view uri);

 private:
  Content urdf_;
  std::string urdf_uri_;
  std::map<std::string, std::string, std::less<>> files_;         // by name in the URDF
  std::map<std::string, std::weak_ptr<const std::string>> read_;  // by file
};

}  // namespace kadans
