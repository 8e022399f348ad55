// A symmetric matrix over the joints of a control object. It stores the lower triangle only, row by row: the high level
// hands it to the low level by copying, and this halves the bytes. Rows count the object's joints, not the model's.
#pragma once

#include <array>
#include <cstddef>

#include "kadans/signal/capacity.h"

namespace kadans {

struct JointMatrix {
  std::array<double, max_joints*(max_joints + 1) / 2> lower{};

  // Row and column in either order, both < max_joints.
  double& operator()(std::size_t row, std::size_t column) noexcept { return lower[place(row, column)]; }
  double operator()(std::size_t row, std::size_t column) const noexcept { return lower[place(row, column)]; }

  // The matrix times the first `size` values of `in`. Goes through the triangle once and uses each entry for both of
  // its places.
  std::array<double, max_joints> times(const std::array<double, max_joints>& in, std::size_t size) const noexcept {
    std::array<double, max_joints> out{};
    const double* entry = lower.data();
    for (std::size_t row = 0; row < size; ++row) {
      double sum = 0;
      for (std::size_t column = 0; column < row; ++column, ++entry) {
        sum += *entry * in[column];
        out[column] += *entry * in[row];
      }
      out[row] += sum + *entry++ * in[row];
    }
    return out;
  }

 private:
  static constexpr std::size_t place(std::size_t row, std::size_t column) noexcept {
    return row >= column ? row * (row + 1) / 2 + column : column * (column + 1) / 2 + row;
  }
};

}  // namespace kadans
