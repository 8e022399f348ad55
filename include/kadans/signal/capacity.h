// The fixed sizes of everything that crosses a seam. The tick never allocates, so its frames are as large as the
// largest robot; counts in the frames say how much of them is in use.
#pragma once

#include <cstddef>

namespace kadans {

inline constexpr std::size_t max_joints = 64;
inline constexpr std::size_t max_feet = 8;
inline constexpr std::size_t sensors_per_foot = 4;  // heel/toe x inner/outer
inline constexpr std::size_t max_channels = 32;     // sensors other than joints, IMU and feet
inline constexpr std::size_t max_seen = 16;         // entries of the world model
inline constexpr std::size_t max_seen_fields = 8;   // of an entry
inline constexpr std::size_t max_objects = 32;      // control objects, over all control sets
inline constexpr std::size_t max_control_sets = 32;
inline constexpr std::size_t max_setpoints_shown = 128;  // in a snapshot
inline constexpr std::size_t max_transaction = 256;      // commands in one transaction, its header included
inline constexpr std::size_t command_capacity = 1024;

}  // namespace kadans
