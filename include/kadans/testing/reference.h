// References to track: one value per tick.
#pragma once

#include <vector>

namespace kadans::testing {

// offset + amplitude sin(2 pi f t); at t = 0 it is at the offset and moves.
std::vector<double> sine_reference(double amplitude, double frequency_Hz, double duration_s, double dt_s,
                                   double offset = 0);
// A sine whose frequency grows evenly from low_Hz to high_Hz.
std::vector<double> chirp_reference(double amplitude, double low_Hz, double high_Hz, double duration_s, double dt_s,
                                    double offset = 0);
// From one value to the other and back, at rest at both ends (minimum jerk), in duration_s.
std::vector<double> there_and_back_reference(double from, double to, double duration_s, double dt_s);

}  // namespace kadans::testing
