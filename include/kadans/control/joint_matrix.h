// A symmetric matrix over the joints of a control object, its lower triangle row by row: half the bytes of a square,
// for what the high level hands to the low level by copying. Rows count the object's joints, not the model's.
#pragma once

#include <array>
#include <cstddef>

#include "kadans/signal/capacity.h"

namespace kadans {

struct JointMatrix {
  std::array<double, max_joints*(max_joints + 1) / 2> lower{};

  // Both in either order, < max_joints.
  double& operator()(std::size_t row, std::size_t column) noexcept { return lower[place(row, column)]; }
  double operator()(std::size_t row, std::size_t column) const noexcept { return lower[place(row, column)]; }

 private:
  static constexpr std::size_t place(std::size_t row, std::size_t column) noexcept {
    return row >= column ? row * (row + 1) / 2 + column : column * (column + 1) / 2 + row;
  }
};

}  // namespace kadans
