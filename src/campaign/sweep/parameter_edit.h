// Writes parameters into the text of a robot's configuration. Everything else stays as it is: order, comments, blanks,
// other numbers.
#pragma once

#include <string>
#include <vector>

namespace kadans {

struct ParameterEdit {
  std::string object;                // the control object's name
  std::string pattern;               // over its parameters' names, without the object's name
  std::vector<std::string> matched;  // names of the parameters that the pattern chooses, without the object's name
  double value = 0;
  std::string preset{};  // preset of the object that gets the value; "": the object's parameters
};

struct BehaviorEdit {
  std::string behavior, parameter;
  double value = 0;
};

// An entry with the same pattern gets the new number. Without such an entry, one is added at the end, where it
// overrules those before it. When a later entry overrules the pattern, each of its parameters is written by its own
// name. `file` only names the text. Throws InputError when the object or the preset does not exist, or when a
// parameter's own entry is overruled by a later one.
std::string edit_parameters(const std::string& text, const std::string& file, const std::vector<ParameterEdit>& edits);

// The same for the parameters of behaviors, under the key "behaviors". An entry that does not exist yet is added.
std::string edit_behaviors(const std::string& text, const std::string& file, const std::vector<BehaviorEdit>& edits);

}  // namespace kadans
