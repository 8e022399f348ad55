// Writes parameters into the text of a robot's configuration and leaves everything else as it stands: order, comments,
// blanks, other numbers.
#pragma once

#include <string>
#include <vector>

namespace kadans {

struct ParameterEdit {
  std::string object;                // the control object's name
  std::string pattern;               // over its parameters, without the object's name
  std::vector<std::string> matched;  // the parameters that it chooses, likewise
  double value = 0;
  std::string preset{};  // of the object, in which it goes; "": its parameters
};

struct BehaviorEdit {
  std::string behavior, parameter;
  double value = 0;
};

// An entry with the same pattern gets the new number, unless a later one overrules it; else an entry is added at the
// end, where it overrules those before it. `file` only names the text. Throws InputError when an object, or the preset
// in it, is not there.
std::string edit_parameters(const std::string& text, const std::string& file, const std::vector<ParameterEdit>& edits);

// Likewise, among what `behaviors` says of the robot's behaviors. What is not there yet is added.
std::string edit_behaviors(const std::string& text, const std::string& file, const std::vector<BehaviorEdit>& edits);

}  // namespace kadans
