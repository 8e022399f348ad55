// Which signals a record holds, and how often: rates by patterns over the signals' names, later entries override
// earlier ones. A robot's configuration says so, a run's command line may say otherwise:
//
//   "record": {"signals": {"plant.*": 0, "control.*": 100}}     the rest in each tick
//   --signals "joint.*, base.*@100"                             these and nothing else
//
// Whether a pattern fits a signal shows only when the signals of the run are declared: ticks_between() says so.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kadans/config/fields.h"
#include "kadans/signal/signal.h"

namespace kadans {

struct SignalChoice {
  std::string file;                   // or the option, for messages
  std::vector<NumberEntry> rates_Hz;  // 0: not recorded; infinite: in each tick
  bool others = true;                 // signals that no entry fits are recorded in each tick
};

struct RecordConfig {
  SignalChoice signals;
  bool single_precision = false;
  double flight_s = 30;  // what a flight recorder keeps; 0: there is none
  double flight_MB = 8;  // in which it keeps that, packed
};

void record_fields(Fields& f, RecordConfig& record);

// "joint.*, base.*@100". Throws InputError that names `option`.
SignalChoice parse_signal_choice(const std::string& text, const std::string& option);

// By signal: each n-th tick, 0: not at all. Throws InputError with the place of a pattern that fits no signal and the
// name that was meant, and of a rate that is not the control rate divided by a whole number. Signals of what not every
// run has, a model's truth (plant.*) and behaviors (behavior.*), need not be there.
std::vector<std::uint32_t> ticks_between(const SignalChoice& choice, const SignalTable& signals,
                                         double control_period_s);

}  // namespace kadans
