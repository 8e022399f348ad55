// A small record, written message by message: rows of two rates, transitions, faults, lines of the log. A tick is a
// millisecond.
#pragma once

#include <initializer_list>
#include <string>
#include <vector>

#include "scratch_file.h"
#include "telemetry/mcap/mcap_writer.h"
#include "telemetry/reading/record_rows.h"
#include "telemetry/record/signal_topics.h"

namespace kadans {

class WrittenRecord {
 public:
  explicit WrittenRecord(Precision precision = Precision::full);

  // A channel of signals, "name|unit" each.
  std::uint16_t rows(const std::vector<std::string>& signals, int every_ticks = 1);
  void row(std::uint16_t channel, std::uint32_t tick, std::initializer_list<double> values);
  void transition(std::uint32_t tick, const std::string& from, const std::string& to);
  void fault(std::uint32_t tick, const std::string& name, const std::string& joint);
  void say(std::uint32_t tick, const std::string& text);
  void describe(std::uint32_t tick, const std::string& json);  // on /description
  McapWriter& writer() noexcept { return writer_; }

  // Completes it.
  const std::string& path();
  RecordOutline outline() { return outline_of(path()); }
  void cut_short();  // to half of its bytes

 private:
  std::uint16_t json_channel(const std::string& topic, const std::string& schema);
  void put(std::uint16_t channel, std::uint32_t tick, const std::string& json);

  ScratchFile file_;
  McapWriter writer_;
  Precision precision_;
  std::map<std::string, std::uint16_t> json_channels_;
};

// knee.angle_rad = tick / 1000 and knee.torque_Nm = -tick each tick, slow.temperature_C = 20 + tick / 100 each tenth;
// a transition at 20 and at 60, a fault at 50, a word at 70, ticks 0 to 99.
void write_knee(WrittenRecord& record);

}  // namespace kadans
