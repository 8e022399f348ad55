// Describes the arguments of the API's functions for editor stubs and the reference. The options of motions come from
// the table that the bindings read (motion_options.h).
#pragma once

#include <string>
#include <string_view>

namespace kadans {

// The type of the argument `name` of a function, as ": kadans.MoveOptions"; "" when any value is allowed.
std::string argument_type(std::string_view function, std::string_view name);
std::string motion_option_stubs();
std::string motion_option_reference();

}  // namespace kadans
