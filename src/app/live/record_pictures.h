// Pictures of a record's robot, drawn by the page in a headless Chromium.
#pragma once

#include <functional>
#include <optional>
#include <string>

namespace kadans {

struct PictureOrder {
  std::string record;
  double at_s = 0;                // one picture ...
  std::optional<double> every_s;  // ... or one each so many seconds
  std::string theme = "light";
  int width = 960, height = 720;
};

// "" when they can be drawn here, else what is missing.
std::string pictures_missing();
// Hands each on as it comes, with its name ("00003.200.png", its second) and its bytes. Throws InputError when they
// cannot be drawn, or somebody interrupts.
void draw_record(const PictureOrder& order,
                 const std::function<void(const std::string& name, std::string bytes)>& take);

}  // namespace kadans
