// Checks of a URDF beyond its grammar. Each check notes all mistakes that it finds in the document.
#pragma once

#include "kadans/model/urdf.h"
#include "urdf_outline.h"

namespace kadans {

// Inertias that no body has, geometry that is not one shape, meshes that are not there, materials that nobody defines.
void check_links(UrdfDocument& document, const UrdfOutline& outline, const UrdfOptions& options);

// Types, limits and axes.
void check_joints(UrdfDocument& document, const UrdfOutline& outline);

// Mimics of joints that are missing, fixed, or mimic each other in a ring.
void check_mimics(UrdfDocument& document, const UrdfOutline& outline);

// Names given twice or never defined, two parents, two roots, loops; bodies that move but have no mass.
void check_tree(UrdfDocument& document, const UrdfOutline& outline);

}  // namespace kadans
