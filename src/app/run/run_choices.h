// What was chosen for a run on the command line, beside its scenario. It is kept in the record, so that the run can be
// repeated.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "config/scenario/scenario_config.h"
#include "signal/byte_order.h"

namespace kadans {

// The changes at a moment of a run by which it branches off.
struct RunBranch {
  std::string name;
  std::vector<std::string> set;   // "control.posture.l_knee.kp_Nm_per_rad=100"
  std::string play;               // a list that replaces what plays; "": what plays goes on
  std::vector<std::string> push;  // "torso=0,2,0": an impulse in Ns, world axes, within 0.1 s

  bool empty() const noexcept { return set.empty() && play.empty() && push.empty(); }
};

struct RunChoices {
  std::string scenario;
  std::optional<std::uint64_t> seed;
  std::optional<double> duration_s;
  std::string play;              // a list that replaces the scenario's; "": the scenario's
  std::vector<std::string> set;  // "ground.friction=0.3"
  PluginGate plugins;            // not kept in a record
};

// A text with enough digits to read back the same number.
std::string exact_text(double number);

// Reads "ground.friction=0.3". Throws InputError that names --set.
NumberEntry parse_setting(const std::string& text);
// Reads "torso=0,2,0" as a push at at_s. Throws InputError.
ScenarioPush parse_push(const std::string& text, double at_s);

// Reads the scenario and applies the choices to it. Throws InputError.
ScenarioConfig read_scenario(const RunChoices& choices);

// The command that makes the same choices with this seed.
std::string repeat_command(const RunChoices& choices, std::uint64_t seed);

// Writes choices and a branch as facts of a record, without the scenario's file. choices_of and branch_of read them
// back.
void put_facts(const RunChoices& choices, TextMap& facts);
void put_facts(const RunBranch& branch, TextMap& facts);
// choices_of throws InputError that names the record when a fact is damaged.
RunChoices choices_of(const TextMap& facts, const std::string& record);
RunBranch branch_of(const TextMap& facts);

}  // namespace kadans
