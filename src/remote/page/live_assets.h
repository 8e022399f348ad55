// The files that clients may fetch: the robot's URDF and the meshes that it names, of at most 16 MB each.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "remote/instance/robot_texts.h"

namespace kadans {

class LiveAssets {
 public:
  LiveAssets(const RobotTexts& texts, const std::string& urdf_file);

  using Content = std::shared_ptr<const std::string>;
  // `uri` is "package://tulip/tulip.urdf", "robot.urdf", or a mesh as the URDF names it, also without "package://".
  // Reads the file; holders of the same content share one copy. Returns nullptr when there is no such asset or it
  // cannot be read.
  Content read(std::string_view uri);

 private:
  Content urdf_;
  std::string urdf_uri_;
  std::map<std::string, std::string, std::less<>> files_;         // files by their names in the URDF
  std::map<std::string, std::weak_ptr<const std::string>> read_;  // contents in use, by file
};

}  // namespace kadans
