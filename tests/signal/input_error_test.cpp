#include "kadans/signal/input_error.h"

#include <string>

#include <doctest/doctest.h>

namespace kadans {
namespace {

TEST_CASE("a problem is told as file:line:column: message, without what is not known") {
  CHECK(InputProblem{"robot.json", 12, 5, "unknown key 'kpp'"}.text() == "robot.json:12:5: unknown key 'kpp'");
  CHECK(InputProblem{"robot.json", 12, 0, "unknown key"}.text() == "robot.json:12: unknown key");
  CHECK(InputProblem{"robot.json", 0, 5, "not found"}.text() == "robot.json: not found");
  CHECK(InputProblem{"", 0, 0, "no file given"}.text() == "no file given");
}

TEST_CASE("an input error carries its problems and tells each on a line of its own") {
  const InputError one(InputProblem{"a.urdf", 3, 0, "mass is negative"});
  CHECK(std::string(one.what()) == "a.urdf:3: mass is negative");
  CHECK(one.problems().size() == 1);

  const InputError two({{"a.urdf", 3, 0, "mass is negative"}, {"b.json", 1, 2, "expected a number"}});
  CHECK(std::string(two.what()) == "a.urdf:3: mass is negative\nb.json:1:2: expected a number");
  REQUIRE(two.problems().size() == 2);
  CHECK(two.problems()[1].file == "b.json");
  CHECK(two.problems()[1].column == 2);
}

}  // namespace
}  // namespace kadans
