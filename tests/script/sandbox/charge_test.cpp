// Whether the table of worst cases (charge_cases.cpp, counted by charge_count.cpp) is whole.
#include <doctest/doctest.h>

#include "charge_cases.h"

using namespace kadans::script_test;

TEST_CASE("every function that a script reaches has its worst cases in the table of charges") {
  ChargedScript script;
  std::set<std::string> known;
  for (const ChargeCase& of : charge_cases()) known.insert(of.function);
  for (const std::string& name : script.reachable()) CHECK_MESSAGE(known.contains(name), name);
}

TEST_CASE("the calls of the table of charges can be made") {
  ChargedScript script;
  for (const ChargeCase& of : charge_cases()) {
    CAPTURE(std::string(of.code));
    CHECK(script.run(of).error == "");
  }
}
