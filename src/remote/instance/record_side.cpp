#include "record_side.h"

#include <algorithm>

#include "signal/input_file.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t timing_period_ns = 1'000'000'000;

constexpr std::int64_t bounds_period_ns = 1'000'000'000;
constexpr std::int64_t between_files_ns = 10'000'000'000;  // a disk that fails gets no new file each second

}  // namespace

void RecordSide::record_as(RecordPlan plan) {
  plan_ = std::move(plan);
  constexpr std::uint64_t files_min = 4;  // so that what was just recorded does not go
  if (plan_.folder_bytes > 0) plan_.file_bytes = std::min(plan_.file_bytes, plan_.folder_bytes / files_min);
  folder_ = RecordFolder(instance_.facts().records, instance_.facts().name, plan_.folder_bytes);
}

void RecordSide::make_recorder() {
  if (recorder_) return;
  recorder_ = std::make_unique<Recorder>(instance_.catalog().signals, plan_.settings, plan_.flight);
  inputs_in_files_ = plan_.inputs.pieces != nullptr && plan_.inputs.in_files;
  if (plan_.inputs.pieces) recorder_->record_inputs(std::move(plan_.inputs));
  told_.store(recorder_.get(), std::memory_order_release);
}

void RecordSide::begin() {
  if (!(plan_.flight.kept_s > 0) || others_) return;
  make_recorder();
  events_.store(&recorder_->events(), std::memory_order_release);
  control_.record_to(recorder_.get());
}

// A record, or what the flight recorder writes.
void RecordSide::describe(RecordWriter& record, std::int64_t time_ns) const {
  const bool holds_inputs = &record == &recorder_->file() ? inputs_in_files_ : recorder_->flight()->takes_inputs();
  const bool repeats = !inputs_.empty() && holds_inputs;
  if (!repeats)
    (void)record.describe("run", inputs_.run);
  else
    (void)record.describe_run(inputs_);
  describe_robots(record, texts_, time_ns);
}

void RecordSide::start(const std::string& file) {
  make_recorder();
  unnamed_ = file.empty();
  if (unnamed_) (void)folder_.make_room(plan_.file_bytes, {});
  const std::string whole = unnamed_ ? folder_.next("").string() : file;
  if (!recorder_->open(whole)) refuse(recorder_->error());
  describe(recorder_->file(), time_ns_);
  file_ = whole;
  events_.store(&recorder_->events(), std::memory_order_release);
  control_.record_to(recorder_.get());
  publish();
}

void RecordSide::leave_to(RecordSink& own, const std::string& file) {
  file_ = file;
  others_ = true;
  control_.record_to(&own);
}

bool RecordSide::stop() {
  if (file_.empty() || others_) return true;
  if (recorder_->flight() == nullptr) {
    control_.record_to(nullptr);
    events_.store(nullptr, std::memory_order_release);
  }
  const bool whole = recorder_->close() && lost_.empty();
  publish();
  file_.clear();
  unnamed_ = false;
  return whole;
}

bool RecordSide::end() {
  const bool whole = stop();
  if (!recorder_ || recorder_->flight() == nullptr) return whole;
  (void)recorder_->drain();
  hand_over(true);
  recorder_->flight()->finish();
  publish();
  return whole && recorder_->flight()->error().empty();
}

std::string RecordSide::error() const {
  if (!recorder_) return "";
  if (!lost_.empty()) return lost_;
  const bool of_flight = recorder_->error().empty() && recorder_->flight() != nullptr;
  return of_flight ? recorder_->flight()->error() : recorder_->error();
}

// Once a second: the open record does not become too large, nor all of them together.
void RecordSide::keep_bounds() {
  if (time_ns_ < bounds_kept_ns_ + bounds_period_ns) return;
  bounds_kept_ns_ = time_ns_;
  const bool open = !file_.empty() && !others_;
  if (open && unnamed_) {
    const bool failed = !recorder_->error().empty() && time_ns_ >= went_on_ns_ + between_files_ns;
    const bool full = recorder_->error().empty() && plan_.file_bytes > 0 && recorder_->file_bytes() >= plan_.file_bytes;
    if (failed || full) go_on_in_next();
  }
  const FlightRecorder* const flight = recorder_ ? recorder_->flight() : nullptr;
  (void)folder_.make_room(0, {fs::path(file_), flight != nullptr ? fs::path(flight->file()) : fs::path()});
}

void RecordSide::go_on_in_next() {
  went_on_ns_ = time_ns_;
  (void)folder_.make_room(plan_.file_bytes, {fs::path(file_)});
  if (lost_.empty()) lost_ = recorder_->error();
  const std::string next = folder_.next("").string();
  (void)recorder_->file().describe("goes_on", {{"file", fs::path(next).filename().string()}});
  if (!recorder_->go_on_in(next)) return;  // told at the end, and tried again
  describe(recorder_->file(), time_ns_);
  file_ = next;
}

bool RecordSide::beat(const Beat& beat) {
  time_ns_ = beat.due_ns;
  // A disk that fails is told at the end; the robot goes on.
  const bool open = !file_.empty() && !others_;
  if (recorder_ && (open || recorder_->flight() != nullptr)) (void)recorder_->drain();
  if (open) tell_timing();
  hand_over(false);
  keep_bounds();
  for (const auto& port : instance_.ports()) {
    while (std::unique_ptr<OrderCase> order = port->records_.take()) {
      try {
        carry_out(*order);
      } catch (const std::exception& error) {
        order->answer.text = error.what();
      }
      port->records_.answer(std::move(order));
    }
  }
  publish();
  return true;
}

void RecordSide::tell_timing() {
  if (plan_.timing.empty() || time_ns_ < timing_told_ns_ + timing_period_ns) return;
  timing_told_ns_ = time_ns_;
  recorder_->timing(timing_json(plan_.timing), time_ns_);
}

// A latched fault gets its file.
void RecordSide::hand_over(bool at_once) {
  FlightRecorder* flight = recorder_ ? recorder_->flight() : nullptr;
  if (flight == nullptr) return;
  if (ending_.load(std::memory_order_relaxed)) flight->watch_no_more();
  if (!flight->due(at_once)) return;
  fly(folder_.next("_flight"));
}

void RecordSide::fly(const fs::path& file) {
  FlightRecorder& flight = *recorder_->flight();
  if (!flight.begin(file.string())) return;
  describe(flight.dump(), 0);
  if (plan_.fault_state != nullptr) (void)flight.dump().describe("fault_state", plan_.fault_state->facts());
}

void RecordSide::carry_out(OrderCase& order) {
  Answer& answer = order.answer;
  if (order.order.kind == Order::Kind::record_start) {
    if (!file_.empty()) refuse("a record goes on already: " + file_);
    start(order.order.text.empty() ? "" : file_for(order.order.text, "").string());
    answer.text = file_;
    answer.done = true;
    return;
  }
  if (order.order.kind == Order::Kind::record_dump) {
    FlightRecorder* flight = recorder_ ? recorder_->flight() : nullptr;
    if (flight == nullptr) refuse("there is no flight recorder: this run has --flight 0");
    if (flight->busy()) refuse(flight->file() + " is being written");
    fly(file_for(order.order.text, "_flight"));
    answer.text = flight->busy() ? flight->file() : flight->error();
    answer.done = flight->busy();
    return;
  }
  if (file_.empty()) refuse("there is no record to stop");
  if (others_) refuse(file_ + " was begun with this run and ends with it");
  const std::string file = file_;
  answer.done = stop();
  answer.text = file + (answer.done ? "" : " is not complete: " + recorder_->error());
}

fs::path RecordSide::file_for(const std::string& name, const char* suffix) const {
  if (name.empty()) return folder_.next(suffix);
  const fs::path file = name;
  if (file.has_parent_path() || file.extension() != ".mcap" || file.stem().empty())
    refuse("a record's name ends with .mcap and names no folder; records lie in " + instance_.facts().records.string());
  const fs::path whole = instance_.facts().records / file;
  if (fs::symlink_status(whole).type() != fs::file_type::not_found) refuse(whole.string() + " is there already");
  return whole;
}

void RecordSide::publish() {
  RecordStatus status;
  if (!file_.empty()) {
    status.goes_on = true;
    if (!others_) {
      status.failed = !recorder_->error().empty();
      status.rows = recorder_->rows();
      status.bytes = recorder_->file_bytes();
      status.dropped = recorder_->dropped();
    }
    put_text(status.file, file_);
  }
  if (recorder_ && recorder_->flight() != nullptr) {
    status.flights = recorder_->flight()->dumps();
    put_text(status.flight, recorder_->flight()->file());
  }
  status_.publish(status);
}

}  // namespace kadans
