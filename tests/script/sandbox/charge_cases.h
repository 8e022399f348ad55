// Every C function that a script reaches, with the worst arguments that anybody could think of: what it is charged, and
// the work to be counted (charge_count.cpp).
#pragma once

#include <memory>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace kadans::script_test {

struct ChargeCase {
  const char* function;  // as a script would call it
  const char* code;      // with k, m, s, P, motion, node: returns what is called, and its arguments
};

std::span<const ChargeCase> charge_cases();

// A behavior in which the cases are run, one after the other.
class ChargedScript {
 public:
  ChargedScript();
  ~ChargedScript();
  ChargedScript(const ChargedScript&) = delete;
  ChargedScript& operator=(const ChargedScript&) = delete;

  struct Charge {
    std::string error{};  // of the code around the call; "" when it could be made
    double instructions = 0;
    double values = 0;  // handed over
  };
  // The call itself is made by kadans_charged_call().
  Charge run(const ChargeCase& of);
  // Names of the C functions in the globals, the module, m, control objects, motions, nodes and parameters.
  std::set<std::string> reachable();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace kadans::script_test
