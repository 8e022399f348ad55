// What the links of a robot touch that is not the robot, read after a step of dt_s.
#pragma once

#include "plant/bullet/truth.h"

namespace kadans::bullet {

void read_contacts(const ContactWorld& world, const Body& body, double dt_s, PlantTruth& truth);

// Adds up the ground's contact impulses on each foot. Keeps the links in `feet` and writes everything else.
void read_feet(const ContactWorld& world, const Body& body, const std::vector<FootSettings>& settings, double dt_s,
               std::vector<FootLoad>& feet);

}  // namespace kadans::bullet
