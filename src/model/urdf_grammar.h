// URDF's elements in one table: which attributes and children each has, which values they take, how often they come.
// check_grammar compares a document with it. What the table cannot say (trees, inertias, limits) is in urdf_checks.h.
// At the top level foreign elements (gazebo, transmission, ...) are ignored, unless their name is almost one of URDF's.
// Elements and attributes with a name space (drake:..., xml:...) are ignored everywhere.
#pragma once

#include <string_view>

#include "urdf_document.h"

namespace kadans {

// Throws when the text is xacro that has not been expanded: every other mistake would be a consequence.
void check_xacro(UrdfDocument& document);
void check_grammar(UrdfDocument& document);

bool known_attribute(std::string_view element, std::string_view attribute);
bool known_child(std::string_view element, std::string_view child);

}  // namespace kadans
