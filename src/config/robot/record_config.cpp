#include "record_config.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "kadans/signal/nearest_name.h"
#include "signal/input_file.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

constexpr double each_tick = std::numeric_limits<double>::infinity();
constexpr double rate_max_Hz = 1e5;

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t"), last = text.find_last_not_of(" \t");
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

bool not_in_every_run(const std::string& pattern) {
  return pattern.starts_with("plant.") || pattern.starts_with("behavior.");
}

// What was meant by a pattern without a signal: the nearest name, or the nearest first part of one.
std::string meant(const std::string& pattern, const std::vector<std::string>& names) {
  if (pattern.find('*') == std::string::npos) {
    const auto longer = std::ranges::find_if(names, [&](const std::string& name) { return name.starts_with(pattern); });
    return longer == names.end() ? did_you_mean(pattern, names) : ", did you mean '" + *longer + "'?";
  }
  std::vector<std::string> starts;
  for (const std::string& name : names) {
    const std::string start = name.substr(0, name.find('.'));
    if (starts.empty() || starts.back() != start) starts.push_back(start);
  }
  const std::size_t dot = pattern.find('.');
  const std::string near = nearest_name(pattern.substr(0, dot), starts);
  if (near.empty() || dot == std::string::npos || near == pattern.substr(0, dot)) return "";
  return ", did you mean '" + near + pattern.substr(dot) + "'?";
}

// The nearest whole number, at least 1.
std::uint32_t ticks_near(double rate_Hz, double control_period_s) {
  constexpr double most = std::numeric_limits<std::uint32_t>::max();
  return static_cast<std::uint32_t>(std::clamp(std::round(1 / (rate_Hz * control_period_s)), 1.0, most));
}

// Throws when the rate is none that ticks can have.
std::uint32_t ticks_of(const NumberEntry& entry, const std::string& file, double control_period_s) {
  if (entry.value == 0) return 0;
  if (entry.value == each_tick) return 1;
  const double ticks = 1 / (entry.value * control_period_s);
  const std::uint32_t whole = ticks_near(entry.value, control_period_s);
  if (std::abs(ticks - whole) <= 1e-3 * whole) return whole;
  refuse(file, entry.value_place,
         "'" + entry.key + "' at " + number_text(entry.value) + " Hz: must be the control rate, " +
             number_text(1 / control_period_s) + " Hz, divided by a whole number, such as " +
             number_text(1 / (whole * control_period_s)));
}

}  // namespace

void record_fields(Fields& f, RecordConfig& record) {
  f.object("signals", "rate in Hz by a pattern of signal names; later entries override earlier ones; 0: not recorded",
           [&](Fields& signals) {
             signals.number_entries(record.signals.rates_Hz, {0, rate_max_Hz, "Hz"},
                                    "the control rate divided by a whole number");
           });
  f.boolean("single_precision", record.single_precision, "records hold 32-bit numbers: half the size, 7 digits");
  f.boolean("inputs", record.inputs,
            "records of `kadans run` hold all that went into the run, so that `kadans replay` repeats it");
  f.strings("private", record.private_files, {0, 100},
            "files whose content records leave out, as patterns over paths from the project root, such as "
            "behaviors/tulip/secret_*; who runs the record again needs them");
  f.number("flight_s", record.flight_s, {0, 600, "s"},
           "time that `kadans run` keeps in memory and writes when a fault latches; 0: none");
  f.number("flight_MB", record.flight_MB, {1, 1000, "MB"},
           "memory for it; if that does not suffice, a shorter time is kept");
  f.number("file_MB", record.file_MB, {0, 100'000, "MB"},
           "size at which a record that nobody named (--record FOLDER/) goes on in a new file; 0: never");
  f.number("folder_MB", record.folder_MB, {0, 1e7, "MB"},
           "room in a folder for the records of this robot that nobody named, those of the flight recorder among them; "
           "the oldest go; 0: no bound");
}

SignalChoice parse_signal_choice(const std::string& text, const std::string& option) {
  SignalChoice choice{.file = option, .rates_Hz = {}, .others = false};
  std::istringstream items(text);
  for (std::string item; std::getline(items, item, ',');) {
    item = trimmed(item);
    const std::size_t at = item.find('@');
    NumberEntry entry{.key = trimmed(item.substr(0, at)), .value = each_tick, .place = {}, .value_place = {}};
    const auto rate_Hz = at == std::string::npos ? each_tick : number_of<double>(trimmed(item.substr(at + 1)));
    if (entry.key.empty() || !rate_Hz || !(*rate_Hz >= 0))
      refuse(option, in_quotes(item) + " must be PATTERN or PATTERN@HZ, such as base.*@100");
    entry.value = *rate_Hz;
    choice.rates_Hz.push_back(entry);
  }
  if (choice.rates_Hz.empty()) refuse(option, "names no signals, such as joint.*");
  return choice;
}

std::vector<std::uint32_t> ticks_between(const SignalChoice& choice, const SignalTable& signals,
                                         double control_period_s) {
  std::vector<std::uint32_t> ticks(signals.size(), choice.others ? 1 : 0);
  for (SignalId id = 0; choice.others && id < signals.size(); ++id) {
    if (signals.info(id).slow_Hz > 0) ticks[id] = ticks_near(signals.info(id).slow_Hz, control_period_s);
  }
  const std::vector<std::string> names = choice.rates_Hz.empty() ? std::vector<std::string>{} : signals.names();
  for (const NumberEntry& entry : choice.rates_Hz) {
    const std::uint32_t between = ticks_of(entry, choice.file, control_period_s);
    const std::vector<std::size_t> chosen = matching(entry.key, names);
    if (chosen.empty() && !not_in_every_run(entry.key))
      refuse(choice.file, entry.place, "no signal is called " + in_quotes(entry.key) + meant(entry.key, names));
    for (const std::size_t i : chosen) ticks[i] = between;
  }
  if (std::ranges::count(ticks, 1U) == std::ssize(ticks)) ticks.clear();
  return ticks;
}

std::vector<std::uint32_t> repeated_flight_ticks(const SignalTable& signals, double control_period_s) {
  constexpr double beside_Hz = 100;
  const std::vector<std::string> names = signals.names();
  std::vector<std::uint32_t> ticks = ticks_between({}, signals, control_period_s);
  ticks.resize(names.size(), 1);
  for (const char* const pattern : {"control.*", "*.control.*", "plant.*", "*.plant.*"}) {
    for (const std::size_t i : matching(pattern, names))
      ticks[i] = std::max(ticks[i], ticks_near(beside_Hz, control_period_s));
  }
  return ticks;
}

}  // namespace kadans
