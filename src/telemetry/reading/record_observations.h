// What a robot observed in a recorded run, in the order in which it came: for perception that is fed again. A record
// has it as the signals of the world model, seen.NAME.FIELD. They tell where a thing is as seen from the robot in each
// tick; an observation has arrived when the time that they are of, which is now less age_s, is a new one. The odometry
// in the record carries its place back to where the robot was then.
//
// As text it is the sequence of scripts/play_perception: time_s,entry,age_s,confidence and the entry's fields.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace kadans {

struct RecordedObservation {
  std::int64_t came_ns = 0;  // on the record's clock
  std::string entry;
  double age_s = 0;  // when it came
  double confidence = 1;
  std::vector<std::pair<std::string, double>> fields{};  // a place as it was seen then
};

// Of a record, or of a sequence as text. Throws InputError: the file cannot be read, has no observations, or has a
// wrong line.
std::vector<RecordedObservation> read_observations(const std::string& file);

// The lines of the sequence, with its head.
std::vector<std::string> observation_lines(const std::vector<RecordedObservation>& observations);

}  // namespace kadans
