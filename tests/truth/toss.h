// A recorded toss of a cube, and how far a simulation that began as it did is from it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kadans/model/robot_model.h"

namespace kadans::truth {

inline constexpr double edge_m = 0.1048, mass_kg = 0.37, inertia_kg_m2 = 0.00081;  // as its owners measured them
inline constexpr double frame_s = 1.0 / 148;

struct Toss {
  std::string name;
  Vec3 velocity_m_s{}, angular_velocity_rad_s{};  // of the first frame, world axes
  std::vector<Pose> frames;                       // of the cube's centre
};

// The tosses in a folder, by name, as scripts/tosses writes them (README.md). Throws std::runtime_error with file and
// line.
std::vector<Toss> read_tosses(const std::filesystem::path& folder);

// Half of the tosses, drawn by the seed 1: the ones that parameters are fitted to, or those that are held back.
enum class Half : std::uint8_t { fitted, held };
std::vector<Toss> half_of(const std::vector<Toss>& tosses, Half half);

struct Errors {
  // Over all frames but the first: the mean, and that of the last frame.
  double position_m = 0, position_end_m = 0;
  double rotation_rad = 0, rotation_end_rad = 0;
  // The mean distance of the cube's eight corners from where they were: both in one number.
  double corner_m = 0;
};
Errors errors_of(const Toss& toss, const std::vector<Pose>& simulated);

// The mean over tosses.
Errors mean(const std::vector<Errors>& each);

}  // namespace kadans::truth
