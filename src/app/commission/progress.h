// How far a robot's commissioning has come, kept in a file beside its configuration, so that it goes on where it was
// cut off.
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace kadans {

class Progress {
 public:
  // Reads ROBOT.commission where there is one, of the same type of plant. Throws InputError when it is none.
  Progress(const std::string& robot, std::string plant, bool anew);

  bool done(std::string_view step, const std::string& joint) const;
  const std::string& found(std::string_view step, const std::string& joint) const;
  // Written durably at once.
  void set(std::string_view step, const std::string& joint, const std::string& found);

 private:
  std::string file_, plant_;
  std::map<std::string, std::map<std::string, std::string>> steps_;
};

}  // namespace kadans
