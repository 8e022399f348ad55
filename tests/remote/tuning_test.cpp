#include <doctest/doctest.h>

#include "remote/instance/parameter_history.h"

namespace tuning_test {

using namespace kadans;

TEST_CASE("what is unsaved is the way from the configuration to now, whatever the steps") {
  ParameterHistory history;
  history.note({"kp", 10, 20});
  history.note({"kp", 20, 30});
  REQUIRE(history.unsaved().size() == 1);
  CHECK(history.unsaved()[0].before == 10);
  CHECK(history.unsaved()[0].now == 30);
  CHECK(history.newest()->now == 30);
  history.drop();
  CHECK(history.unsaved()[0].now == 20);
  history.drop();
  CHECK(history.unsaved().empty());
  CHECK(history.newest() == nullptr);
}

TEST_CASE("undoing what was saved is a change again, and a value set while it was saved stays unsaved") {
  ParameterHistory history;
  history.note({"kp", 10, 20});
  const auto saving = history.unsaved();
  history.note({"kp", 20, 25});
  history.saved(saving);
  REQUIRE(history.unsaved().size() == 1);
  CHECK(history.unsaved()[0].before == 20);
  history.saved(history.unsaved());
  CHECK(history.unsaved().empty());
  history.drop();
  REQUIRE(history.unsaved().size() == 1);
  CHECK(history.unsaved()[0].before == 25);
  CHECK(history.unsaved()[0].now == 20);
}

TEST_CASE("what was set in this run is known after it was saved, until it is as it was") {
  ParameterHistory history;
  history.note({"kp", 10, 20});
  history.note({"squat.depth_m", 0.1, 0.2, "squat.lua"});
  history.saved(history.unsaved());
  CHECK(history.unsaved().empty());
  REQUIRE(history.set().size() == 2);
  CHECK(history.set()[1].chunk == "squat.lua");
  history.drop();
  REQUIRE(history.set().size() == 1);
  CHECK(history.set()[0].now == 20);
  REQUIRE(history.unsaved().size() == 1);
  CHECK(history.unsaved()[0].chunk == "squat.lua");
}

TEST_CASE("the way back has an end") {
  ParameterHistory history;
  for (double value = 0; value < 2000; ++value) history.note({"kp", value, value + 1});
  std::size_t steps = 0;
  for (; history.newest() != nullptr; ++steps) history.drop();
  CHECK(steps == ParameterHistory::steps_max);
}

}  // namespace tuning_test
