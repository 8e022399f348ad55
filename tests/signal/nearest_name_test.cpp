#include "kadans/signal/nearest_name.h"

#include <string>
#include <vector>

#include <doctest/doctest.h>

namespace kadans {
namespace {

const std::vector<std::string> joints{"l_hip_y", "l_hip_x", "l_knee", "l_ankle_y", "r_knee", "neck"};

TEST_CASE("the nearest name mends a letter missing, added, wrong or swapped") {
  CHECK(nearest_name("l_kne", joints) == "l_knee");
  CHECK(nearest_name("l_kneee", joints) == "l_knee");
  CHECK(nearest_name("l_knie", joints) == "l_knee");
  CHECK(nearest_name("l_kene", joints) == "l_knee");
  CHECK(nearest_name("L_KNEE", joints) == "l_knee");
  CHECK(nearest_name("l_ankel_y", joints) == "l_ankle_y");
}

TEST_CASE("the nearest name is the name itself when it is known") {
  for (const std::string& joint : joints) CHECK(nearest_name(joint, joints) == joint);
}

TEST_CASE("of two names equally near the first one is taken, so messages repeat") {
  CHECK(nearest_name("knee", std::vector<std::string>{"l_knee", "r_knee"}).empty());
  CHECK(nearest_name("x_knee", std::vector<std::string>{"r_knee", "l_knee"}) == "r_knee");
  CHECK(nearest_name("x_knee", std::vector<std::string>{"l_knee", "r_knee"}) == "l_knee");
}

TEST_CASE("a wrong case is nearer than a wrong letter") {
  CHECK(nearest_name("kP", std::vector<std::string>{"ki", "kp"}) == "kp");
}

TEST_CASE("nothing is meant by a name far from all, by an endless one, or where nothing is known") {
  CHECK(nearest_name("banana", joints).empty());
  CHECK(nearest_name(std::string(1'000'000, 'l'), joints).empty());
  CHECK(nearest_name("l_knee", std::vector<std::string>{}).empty());
}

TEST_CASE("did_you_mean is a phrase to append, or nothing") {
  CHECK("unknown joint 'l_kne'" + did_you_mean("l_kne", joints) == "unknown joint 'l_kne', did you mean 'l_knee'?");
  CHECK(did_you_mean("banana", joints).empty());
}

}  // namespace
}  // namespace kadans
