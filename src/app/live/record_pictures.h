// Draws pictures of a record's robot with the web page in a headless Chromium.
#pragma once

#include <functional>
#include <optional>
#include <string>

namespace kadans {

struct PictureOptions {
  std::string record;
  double at_s = 0;                // time of one picture ...
  std::optional<double> every_s;  // ... or the interval between pictures
  std::string theme = "light";
  int width = 960, height = 720;
};

// "" when pictures can be drawn here, else what is missing.
std::string pictures_missing();
// Calls `take` for each picture as it comes, with its name ("00003.200.png", its time in s) and its bytes. Throws
// InputError when they cannot be drawn, or when the program is interrupted.
void draw_record(const PictureOptions& options,
                 const std::function<void(const std::string& name, std::string bytes)>& take);

}  // namespace kadans
