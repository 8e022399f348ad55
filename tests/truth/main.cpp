// How well an engine predicts recorded tosses, as a program that `kadans tune` asks:
//   kadans_truth kadans|bullet|mujoco fitted|held|all FOLDER [--each] PARAMETER=VALUE...
// The last line is a JSON object: means over the tosses, and medians. --each prints a line for each toss before it.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <numbers>
#include <stdexcept>

#include "cube.h"

namespace kadans::truth {
namespace {

std::unique_ptr<Cube> make_cube(const std::string& engine, const Parameters& parameters) {
  if (engine == "kadans") return kadans_cube(parameters);
  if (engine == "bullet") return bullet_cube(parameters);
  if (engine == "mujoco") return mujoco_cube(parameters);
  throw std::invalid_argument("there is no engine " + engine);
}

std::vector<Toss> chosen(const std::string& half, const std::string& folder) {
  std::vector<Toss> tosses = read_tosses(folder);
  if (half == "all") return tosses;
  if (half != "fitted" && half != "held") throw std::invalid_argument("there is no half " + half);
  return half_of(tosses, half == "fitted" ? Half::fitted : Half::held);
}

void parse(const std::string& argument, Parameters& parameters) {
  const std::size_t equals = argument.find('=');
  if (equals == std::string::npos) throw std::invalid_argument(argument + " must be PARAMETER=VALUE");
  char* end = nullptr;
  const std::string value = argument.substr(equals + 1);
  parameters[argument.substr(0, equals)] = std::strtod(value.c_str(), &end);
  if (value.empty() || *end != '\0') throw std::invalid_argument(argument + " has no number");
}

double degrees(double angle_rad) { return angle_rad * 180 / std::numbers::pi; }

double median(const std::vector<Errors>& each, double Errors::*member) {
  std::vector<double> values;
  for (const Errors& one : each) values.push_back(one.*member);
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

int run(int argc, char** argv) {
  std::vector<std::string> arguments(argv + 1, argv + argc);
  const bool each_one = std::erase(arguments, "--each") > 0;
  if (arguments.size() < 3) {
    std::fputs("kadans_truth kadans|bullet|mujoco fitted|held|all FOLDER [--each] PARAMETER=VALUE...\n", stderr);
    return 2;
  }
  Parameters parameters;
  for (std::size_t i = 3; i < arguments.size(); ++i) parse(arguments[i], parameters);
  const auto cube = make_cube(arguments[0], parameters);
  const std::vector<Toss> tosses = chosen(arguments[1], arguments[2]);
  const std::vector<Errors> each = replay(*cube, tosses);
  for (std::size_t i = 0; each_one && i < each.size(); ++i) {
    std::printf("%s  %6.2f mm  %6.2f deg  at the end %6.2f mm  %6.2f deg\n", tosses[i].name.c_str(),
                1e3 * each[i].position_m, degrees(each[i].rotation_rad), 1e3 * each[i].position_end_m,
                degrees(each[i].rotation_end_rad));
  }
  const Errors all = mean(each);
  std::printf(
      "{\"tosses\":%zu,\"corner_mm\":%.4f,\"position_mm\":%.4f,\"position_end_mm\":%.4f,\"rotation_deg\":%.4f,"
      "\"rotation_end_deg\":%.4f,\"median_position_mm\":%.4f,\"median_position_end_mm\":%.4f,"
      "\"median_rotation_deg\":%.4f,\"median_rotation_end_deg\":%.4f}\n",
      each.size(), 1e3 * all.corner_m, 1e3 * all.position_m, 1e3 * all.position_end_m, degrees(all.rotation_rad),
      degrees(all.rotation_end_rad), 1e3 * median(each, &Errors::position_m),
      1e3 * median(each, &Errors::position_end_m), degrees(median(each, &Errors::rotation_rad)),
      degrees(median(each, &Errors::rotation_end_rad)));
  return 0;
}

}  // namespace
}  // namespace kadans::truth

int main(int argc, char** argv) {
  try {
    return kadans::truth::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "kadans_truth: %s\n", error.what());
    return 1;
  }
}
