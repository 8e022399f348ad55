// What was asked of a run on the command line, beside its scenario: kept in its record, so that it can be asked again.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kadans/config/scenario_config.h"
#include "kadans/signal/byte_order.h"

namespace kadans {

// What changes at a moment of a run, and lets it part from the one without.
struct RunBranch {
  std::string name;
  std::vector<std::string> set;   // "control.posture.l_knee.kp_Nm_per_rad=100"
  std::string play;               // a list in place of what plays; "" = goes on
  std::vector<std::string> push;  // "torso=0,2,0": an impulse in Ns, world axes, within 0.1 s

  bool empty() const noexcept { return set.empty() && play.empty() && push.empty(); }
};

struct RunRequest {
  std::string scenario;
  std::optional<std::uint64_t> seed;
  std::optional<double> duration_s;
  std::string play;              // a list in place of the scenario's; "" = the scenario's
  std::vector<std::string> set;  // "ground.friction=0.3"
  PluginGate plugins;            // not in a record
};

// With so many digits that reading it gives the same number.
std::string exact_text(double number);

// "ground.friction=0.3". Throws InputError that names `option`.
NumberEntry parse_setting(const std::string& text, const std::string& option = "--set");
// "torso=0,2,0", at a time. Throws InputError.
ScenarioPush parse_push(const std::string& text, double at_s);

// Throws InputError.
ScenarioConfig read_scenario(const RunRequest& request);

// The command that asks for the same, with this seed.
std::string repeat_command(const RunRequest& request, std::uint64_t seed);

// As facts of a record and back; the scenario's file is not among them.
void put_facts(const RunRequest& request, TextMap& facts);
void put_facts(const RunBranch& branch, TextMap& facts);
// Throws InputError that names the record when a fact is damaged.
RunRequest request_of(const TextMap& facts, const std::string& record);
RunBranch branch_of(const TextMap& facts);

}  // namespace kadans
