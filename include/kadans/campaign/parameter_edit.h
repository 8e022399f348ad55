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
};

// An entry with the same pattern gets the new number, unless a later one overrules it; else an entry is added at the
// end, where it overrules those before it. `file` only names the text. Throws InputError when an object is not there.
std::string edit_parameters(const std::string& text, const std::string& file, const std::vector<ParameterEdit>& edits);

}  // namespace kadans
