#include "toss.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "kadans/model/kinematics.h"
#include "kadans/signal/random.h"

namespace kadans::truth {
namespace {

namespace fs = std::filesystem;

class Lines {
 public:
  explicit Lines(const fs::path& file) : name_(file.string()), in_(file) {
    if (!in_) throw std::runtime_error(name_ + " cannot be read");
  }

  bool next() { return ++number_, static_cast<bool>(std::getline(in_, line_)); }
  void expect(const std::string& text) {
    if (!next() || line_ != text) refuse("'" + text + "'");
  }
  template <std::size_t count>
  std::array<double, count> numbers() const {
    std::array<double, count> values{};
    std::istringstream text(line_);
    for (std::size_t i = 0; i < count; ++i) {
      char comma = ',';
      if (!(i == 0 || text >> comma) || comma != ',' || !(text >> values[i]) || !std::isfinite(values[i]))
        refuse(std::to_string(count) + " numbers with commas between them");
    }
    if (!(text >> std::ws).eof()) refuse(std::to_string(count) + " numbers, and nothing after them");
    return values;
  }
  [[noreturn]] void refuse(const std::string& wanted) const {
    throw std::runtime_error(name_ + ":" + std::to_string(number_) + ": there must be " + wanted);
  }

 private:
  std::string name_, line_;
  std::ifstream in_;
  int number_ = 0;
};

Toss read_toss(const fs::path& file) {
  Lines lines(file);
  Toss toss{.name = file.stem().string()};
  lines.expect("first velocity vx_m_s,vy_m_s,vz_m_s,wx_rad_s,wy_rad_s,wz_rad_s");
  if (!lines.next()) lines.refuse("the first velocity");
  const auto twist = lines.numbers<6>();
  std::copy_n(twist.begin(), 3, toss.velocity_m_s.begin());
  std::copy_n(twist.begin() + 3, 3, toss.angular_velocity_rad_s.begin());
  lines.expect("x_m,y_m,z_m,qw,qx,qy,qz");
  while (lines.next()) {
    const auto [x, y, z, qw, qx, qy, qz] = lines.numbers<7>();
    if (!(std::abs(std::hypot(std::hypot(qw, qx), std::hypot(qy, qz)) - 1) < 0.01)) lines.refuse("a unit quaternion");
    toss.frames.push_back({{x, y, z}, normalized({qw, qx, qy, qz})});
  }
  if (toss.frames.size() < 2) lines.refuse("two frames at least");
  return toss;
}

double distance_m(const Vec3& a, const Vec3& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

double angle_rad(const Quat& a, const Quat& b) {
  const Quat apart = multiply(conjugate(a), b);
  return 2 * std::atan2(std::hypot(apart[1], apart[2], apart[3]), std::abs(apart[0]));
}

double corner_distance_m(const Pose& a, const Pose& b) {
  double sum_m = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const auto half = [corner](int axis) { return ((corner >> axis) & 1) != 0 ? edge_m / 2 : -edge_m / 2; };
    const Vec3 at{half(0), half(1), half(2)};
    sum_m += distance_m(transform(a, at), transform(b, at));
  }
  return sum_m / 8;
}

}  // namespace

std::vector<Toss> read_tosses(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().extension() == ".csv") files.push_back(entry.path());
  }
  if (files.empty()) throw std::runtime_error(folder.string() + " holds no tosses: scripts/tosses fetches them");
  std::ranges::sort(files);
  std::vector<Toss> tosses;
  for (const fs::path& file : files) tosses.push_back(read_toss(file));
  return tosses;
}

std::vector<Toss> half_of(const std::vector<Toss>& tosses, Half half) {
  std::vector<std::size_t> order(tosses.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  RandomStream random(1, "truth.halves");
  for (std::size_t i = order.size(); i > 1; --i) {
    std::swap(order[i - 1], order[static_cast<std::size_t>(random.uniform() * static_cast<double>(i))]);
  }
  const auto middle = order.begin() + static_cast<std::ptrdiff_t>(order.size() / 2);
  std::vector<std::size_t> chosen(half == Half::fitted ? order.begin() : middle,
                                  half == Half::fitted ? middle : order.end());
  std::ranges::sort(chosen);
  std::vector<Toss> all;
  for (const std::size_t i : chosen) all.push_back(tosses[i]);
  return all;
}

Errors errors_of(const Toss& toss, const std::vector<Pose>& simulated) {
  if (simulated.size() != toss.frames.size()) throw std::invalid_argument("another number of frames than the toss has");
  Errors errors;
  const double share = 1 / static_cast<double>(toss.frames.size() - 1);
  for (std::size_t i = 1; i < toss.frames.size(); ++i) {
    const Pose &real = toss.frames[i], &ours = simulated[i];
    errors.position_end_m = distance_m(real.position_m, ours.position_m);
    errors.rotation_end_rad = angle_rad(real.orientation, ours.orientation);
    errors.position_m += share * errors.position_end_m;
    errors.rotation_rad += share * errors.rotation_end_rad;
    errors.corner_m += share * corner_distance_m(real, ours);
  }
  return errors;
}

Errors mean(const std::vector<Errors>& each) {
  Errors sum;
  const double share = 1 / static_cast<double>(each.size());
  for (const Errors& one : each) {
    sum.position_m += share * one.position_m;
    sum.position_end_m += share * one.position_end_m;
    sum.rotation_rad += share * one.rotation_rad;
    sum.rotation_end_rad += share * one.rotation_end_rad;
    sum.corner_m += share * one.corner_m;
  }
  return sum;
}

}  // namespace kadans::truth
