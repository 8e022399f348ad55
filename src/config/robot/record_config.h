// Which signals a record holds and at what rate. Rates are given by patterns over the signals' names; later entries
// override earlier ones. A robot's configuration sets them, and a run's command line may override them:
//
//   "record": {"signals": {"plant.*": 0, "control.*": 100}}     these rates, all other signals in each tick
//   --signals "joint.*, base.*@100"                             only these signals
//
// The signals of a run are known only when they are declared, so patterns that fit no signal are found by
// ticks_between().
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "config/json/fields.h"
#include "kadans/signal/signal.h"

namespace kadans {

struct SignalChoice {
  std::string file;                   // the configuration's file or the option's name, for messages
  std::vector<NumberEntry> rates_Hz;  // 0: not recorded; infinity: recorded in each tick
  bool others = true;                 // signals that fit no entry are recorded in each tick
};

struct RecordConfig {
  SignalChoice signals;
  bool single_precision = false;
  bool inputs = true;  // records of runs on threads hold what repeats them
  std::vector<PlacedName>
      private_files;     // patterns over paths from the project's root: records leave their content out
  double flight_s = 30;  // time span that the flight recorder keeps; 0: no flight recorder
  double flight_MB = 8;  // memory for that span, compressed
  double file_MB = 100;  // at which a record that nobody named goes on in a new file; 0: never
  double folder_MB = 0;  // of all such records of the robot in a folder, the oldest go; 0: no bound
};

void record_fields(Fields& f, RecordConfig& record);

// Reads a text such as "joint.*, base.*@100". Throws InputError that names `option`.
SignalChoice parse_signal_choice(const std::string& text, const std::string& option);

// For each signal n: it is recorded in each n-th tick, 0: not at all; an empty list: all signals in each tick. Throws
// InputError with the place for a pattern that fits no signal, with the nearest name, and for a rate that is not the
// control rate divided by a whole number. Patterns for a model's truth (plant.*) and for behaviors (behavior.*) may fit
// no signal, because not every run has such signals.
std::vector<std::uint32_t> ticks_between(const SignalChoice& choice, const SignalTable& signals,
                                         double control_period_s);

// The same for a flight record that can be repeated. It holds all signals: in each tick, but slow ones as they say, and
// what control objects compute and the truth of a simulated plant 100 times a second, because a repetition computes the
// one again and the other is beside the robot.
std::vector<std::uint32_t> repeated_flight_ticks(const SignalTable& signals, double control_period_s);

}  // namespace kadans
