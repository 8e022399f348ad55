// What many files named .urdf have left of xacro: values that are put in for names.
#pragma once

#include <optional>
#include <string>

#include "kadans/signal/input_error.h"

namespace kadans {

struct XacroValues {
  std::string text;   // of the URDF with the values, in the lines that they stood in
  InputProblem told;  // which names were there, what they became, and by what
};

// Puts in what $(arg NAME) has as the default of its <xacro:arg>, ${NAME} as the value of its <xacro:property>, and
// $(env NAME) and $(optenv NAME DEFAULT) of the environment. What has no value stays as it is. Nothing when the text
// has none of these, is not XML, has more of xacro (macros, conditions, files that it includes), or would grow by more
// than 2 MiB, as values of values can.
std::optional<XacroValues> with_xacro_values(const std::string& text, const std::string& file);

}  // namespace kadans
