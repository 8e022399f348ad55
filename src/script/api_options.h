// The arguments of the API's functions in the words of editor stubs and reference; the options of motions come from
// the table that the bindings read (motion_options.h).
#pragma once

#include <string>
#include <string_view>

namespace kadans {

// ": kadans.MoveOptions" of the argument `name` of a function; "" when any value goes.
std::string argument_type(std::string_view function, std::string_view name);
std::string motion_option_stubs();
std::string motion_option_reference();

}  // namespace kadans
