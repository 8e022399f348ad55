#include "record_observations.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <sstream>
#include <utility>

#include "kadans/signal/input_error.h"
#include "record_rows.h"
#include "signal/input_file.h"
#include "signal/number_text.h"
#include "signal/sine_cosine.h"
#include "telemetry/record/record_folder.h"

namespace kadans {
namespace {

constexpr double same_time_s = 2e-4;  // ages of one observation, in ticks that follow, tell one time but for rounding
constexpr double age_max_s = 60;

const double no_value = std::numeric_limits<double>::quiet_NaN();

// The messages of a topic come in the order of time, those of two topics need not. All signals of an entry are in one
// message, those of the odometry in another one; so places are carried back when all of the record was read.
class ObservationReader {
 public:
  explicit ObservationReader(const std::string& record) : file_(record), rows_(record) {}

  std::vector<RecordedObservation> read() {
    while (rows_.next()) {
      if (!rows_.values().empty()) take();
    }
    if (!rows_.reader().complete() && !rows_.reader().problem().empty() && found_.empty())
      refuse(file_, rows_.reader().problem());
    std::ranges::stable_sort(poses_, {}, &Pose::time_ns);
    for (Found& one : found_) {
      if (one.carried) carry_back(one.observation);
    }
    std::ranges::stable_sort(found_, {}, [](const Found& one) { return one.observation.came_ns; });
    std::vector<RecordedObservation> all;
    for (Found& one : found_) all.push_back(std::move(one.observation));
    return all;
  }
  bool has_entries() const noexcept { return !entries_.empty(); }

 private:
  struct Pose {
    std::int64_t time_ns = 0;
    double x_m = 0, y_m = 0, heading_rad = 0;
  };
  struct Entry {
    double age_s = no_value, confidence = 0, carried = 1;
    std::vector<std::pair<std::string, double>> fields{};
    double of_s = no_value;  // time of its last observation
    bool told = false;       // by the message that is looked at
  };
  struct Found {
    RecordedObservation observation;
    bool carried = true;
  };

  // The values of this message.
  void take() {
    const std::vector<Signal>& signals = rows_.topic().signals;
    Pose pose{.time_ns = rows_.time_ns()};
    bool walks = false;
    for (std::size_t i = 0; i < signals.size() && i < rows_.values().size(); ++i) {
      const std::string& name = signals[i].name;
      const double value = rows_.values()[i];
      if (name.starts_with("seen.")) take_seen(name.substr(5), value);
      if (name == "odometry.x_m") pose.x_m = value, walks = true;
      if (name == "odometry.y_m") pose.y_m = value;
      if (name == "odometry.heading_rad") pose.heading_rad = value;
    }
    if (walks) poses_.push_back(pose);
    for (auto& [name, entry] : entries_) {
      if (std::exchange(entry.told, false)) look(name, entry);
    }
  }

  void take_seen(const std::string& name, double value) {
    const std::size_t dot = name.find('.');
    if (dot == std::string::npos) return;
    const std::string field = name.substr(dot + 1);
    Entry& entry = entries_[name.substr(0, dot)];
    entry.told = true;
    if (field == "age_s") {
      entry.age_s = value;
    } else if (field == "confidence") {
      entry.confidence = value;
    } else if (field == "carried") {
      entry.carried = value;
    } else {
      const auto found = std::ranges::find(entry.fields, field, &std::pair<std::string, double>::first);
      if (found == entry.fields.end()) {
        entry.fields.emplace_back(field, value);
      } else {
        found->second = value;
      }
    }
  }

  // Whether it is of another time than the last one.
  void look(const std::string& name, Entry& entry) {
    if (!(entry.confidence > 0) || !(entry.age_s >= 0 && entry.age_s <= age_max_s)) return;
    const double of_s = seconds(rows_.time_ns()) - entry.age_s;
    if (std::abs(of_s - entry.of_s) < same_time_s) return;
    entry.of_s = of_s;
    found_.push_back({{rows_.time_ns(), name, entry.age_s, entry.confidence, entry.fields}, entry.carried != 0});
  }

  // As it was told last by then; nullptr: never.
  const Pose* pose_at(std::int64_t time_ns) const {
    const auto after = std::ranges::upper_bound(poses_, time_ns, {}, &Pose::time_ns);
    return after == poses_.begin() ? nullptr : &*std::prev(after);
  }

  // A place from where the robot is when it comes to where the robot was then.
  void carry_back(RecordedObservation& one) const {
    const auto value = [&](const char* name) -> double* {
      const auto found = std::ranges::find(one.fields, name, &std::pair<std::string, double>::first);
      return found == one.fields.end() ? nullptr : &found->second;
    };
    double *const x_m = value("x_m"), *const y_m = value("y_m"), *const heading_rad = value("heading_rad");
    const Pose* now = pose_at(one.came_ns);
    const Pose* then = pose_at(one.came_ns - std::llround(1e9 * one.age_s));
    if (x_m == nullptr || y_m == nullptr || now == nullptr || then == nullptr) return;
    const auto [sin_now, cos_now] = sine_cosine(now->heading_rad);
    const double at_x_m = now->x_m + cos_now * *x_m - sin_now * *y_m - then->x_m;
    const double at_y_m = now->y_m + sin_now * *x_m + cos_now * *y_m - then->y_m;
    const auto [sin, cos] = sine_cosine(then->heading_rad);
    *x_m = cos * at_x_m + sin * at_y_m;
    *y_m = cos * at_y_m - sin * at_x_m;
    if (heading_rad != nullptr)
      *heading_rad = std::remainder(*heading_rad + now->heading_rad - then->heading_rad, 2 * std::numbers::pi);
  }

  std::string file_;
  RecordRows rows_;
  std::vector<Pose> poses_;
  std::map<std::string, Entry> entries_;
  std::vector<Found> found_;
};

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream text(line);
  for (std::string cell; std::getline(text, cell, ',');) cells.push_back(cell);
  return cells;
}

// A sequence as text. Its lines are in the order of time.
class SequenceReader {
 public:
  explicit SequenceReader(std::string file) : file_(std::move(file)) {}

  std::vector<RecordedObservation> read(std::istream& lines) {
    std::string line;
    if (!next(lines, line)) refuse("is empty: wanted time_s,entry,age_s,confidence and the entry's fields");
    head_ = cells_of(line);
    for (const char* name : {"time_s", "entry"}) {
      if (std::ranges::find(head_, name) == head_.end())
        refuse("the head has no column '" + std::string(name) +
               "': wanted time_s,entry,age_s,confidence and the entry's fields");
    }
    std::vector<RecordedObservation> all;
    while (next(lines, line)) {
      if (line.empty()) continue;
      all.push_back(take(cells_of(line)));
      if (all.size() > 1 && all.back().came_ns < all[all.size() - 2].came_ns)
        refuse("time_s is before that of the line above: the sequence is in the order of time");
    }
    return all;
  }

 private:
  [[noreturn]] void refuse(const std::string& why) const { throw InputError({file_, number_, 0, why}); }

  bool next(std::istream& lines, std::string& line) {
    ++number_;
    if (!std::getline(lines, line)) return false;
    if (line.ends_with('\r')) line.pop_back();
    return true;
  }

  RecordedObservation take(const std::vector<std::string>& cells) const {
    if (cells.size() > head_.size()) refuse("has more cells than the head");
    RecordedObservation one;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (head_[i] == "entry") {
        one.entry = cells[i];
      } else if (!cells[i].empty()) {
        const std::optional<double> value = number_of<double>(cells[i]);
        if (!value || !std::isfinite(*value)) refuse(head_[i] + " must be a number, not '" + cells[i] + "'");
        put(one, head_[i], *value);
      }
    }
    if (one.entry.empty()) refuse("names no entry");
    return one;
  }

  void put(RecordedObservation& one, const std::string& name, double value) const {
    if (name == "time_s") {
      if (!(std::abs(value) <= 9e9)) refuse("time_s must be a time in seconds");
      one.came_ns = std::llround(1e9 * value);
    } else if (name == "age_s") {
      if (!(value >= 0 && value <= age_max_s)) refuse("age_s must be 0.." + number_text(age_max_s) + " s");
      one.age_s = value;
    } else if (name == "confidence") {
      if (!(value >= 0 && value <= 1)) refuse("confidence must be 0..1");
      one.confidence = value;
    } else {
      one.fields.emplace_back(name, value);
    }
  }

  std::string file_;
  int number_ = 0;  // of the line
  std::vector<std::string> head_;
};

}  // namespace

std::vector<RecordedObservation> read_observations(const std::string& file) {
  check_input_file(file);
  if (!is_record(file)) {
    std::ifstream stream(file, std::ios::binary);
    return SequenceReader(file).read(stream);
  }
  ObservationReader reader(file);
  std::vector<RecordedObservation> all = reader.read();
  if (!reader.has_entries())
    refuse(file,
           "has no observations: its robot had no world model (supervisor.world), or the record "
           "was cut without the signals seen.*");
  return all;
}

std::vector<std::string> observation_lines(const std::vector<RecordedObservation>& observations) {
  std::vector<std::string> names;  // of all entries' fields, as they come
  for (const RecordedObservation& one : observations) {
    for (const auto& [name, value] : one.fields) {
      if (std::ranges::find(names, name) == names.end()) names.push_back(name);
    }
  }
  std::string head = "time_s,entry,age_s,confidence";
  for (const std::string& name : names) head += "," + name;
  std::vector<std::string> lines{head};
  for (const RecordedObservation& one : observations) {
    std::string line = number_text(static_cast<double>(one.came_ns) / 1e9) + "," + one.entry + "," +
                       number_text(one.age_s) + "," + number_text(one.confidence);
    for (const std::string& name : names) {
      const auto found = std::ranges::find(one.fields, name, &std::pair<std::string, double>::first);
      line += "," + (found == one.fields.end() || !std::isfinite(found->second) ? "" : number_text(found->second));
    }
    lines.push_back(line);
  }
  return lines;
}

}  // namespace kadans
