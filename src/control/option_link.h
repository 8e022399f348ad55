// The links that the options of control objects name.
//
// Before the loop; they throw OptionError, with the link that was perhaps meant.
#pragma once

#include <cstddef>
#include <string>

#include "kadans/control/control_object.h"

namespace kadans {

std::size_t link_named(const ObjectSetup& setup, const std::string& option, const std::string& name);
// `meaning` says what an option that is missing would name: "a foot's link".
std::size_t required_link(const ObjectSetup& setup, const std::string& option, const std::string& meaning);

}  // namespace kadans
