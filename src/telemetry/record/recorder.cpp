#include "recorder.h"

#include <array>
#include <cstring>
#include <stdexcept>

namespace kadans {

static_assert(std::atomic<std::uint32_t>::is_always_lock_free);

Recorder::Recorder(const SignalTable& signals, const RecorderSettings& settings, const FlightSettings& flight,
                   Wait wait)
    : signals_(signals),
      signal_count_(signals.size()),
      settings_(settings),
      file_(std::make_unique<RecordWriter>(signals, settings)),
      flight_(flight.kept_s > 0 ? std::make_unique<FlightRecorder>(signals, flight, settings) : nullptr),
      stride_(flight_ ? 1 : file_->stride()),
      ring_(wait == Wait::in_ring ? std::make_unique<Rows>() : nullptr),
      row_(signals.size()) {
  if (head_size + signal_count_ > Rows::capacity()) throw std::invalid_argument("too many signals for the record");
}

// What came since the last file was closed is for the flight recorder alone.
bool Recorder::open(const std::string& path) {
  if (opened_) {
    (void)drain();
    return open_new(path);
  }
  opened_ = true;
  return begin_file(path);
}

void Recorder::record_inputs(Inputs inputs) {
  inputs_ = std::move(inputs);
  word_count_ = inputs_.pieces->layout().words();
  words_.resize(word_count_);
  pushed_.reserve(2 + inputs_.pieces->gather().size());
  stride_ = 1;
  if (inputs_.in_files) inputs_ring_ = std::make_unique<Rows>();
}

bool Recorder::begin_file(const std::string& path) {
  if (!file_->open(path)) return false;
  if (!inputs_ring_) return true;
  file_->add_inputs(inputs_.pieces->layout());
  std::vector<bool> exact(signal_count_, settings_.precision == Precision::full);
  for (std::size_t i = 0; i < settings_.every_ticks.size(); ++i) exact[i] = exact[i] && settings_.every_ticks[i] == 1;
  encoder_ = std::make_unique<InputEncoder>(inputs_.pieces->layout(), std::move(exact));
  return true;
}

bool Recorder::open_new(const std::string& path) {
  file_ = std::make_unique<RecordWriter>(signals_, settings_);
  rows_ = lost_ = 0;
  dropped_.store(0, std::memory_order_relaxed);
  reported_drops_ = dropped_events();
  return begin_file(path);
}

void Recorder::record(std::uint64_t tick, std::int64_t time_ns, std::span<const double> row) noexcept {
  if (stride_ == 0 || tick % stride_ != 0) return;
  if (!ring_) {
    if (row.size() == signal_count_ && in_place_.row.empty()) {
      in_place_ = {tick, time_ns, row};
    } else {
      dropped_.fetch_add(1, std::memory_order_relaxed);
    }
    return;
  }
  std::array<double, head_size> head{};
  std::memcpy(&head[0], &tick, sizeof tick);
  std::memcpy(&head[1], &time_ns, sizeof time_ns);
  if (row.size() != signal_count_ || !push(head, row)) dropped_.fetch_add(1, std::memory_order_relaxed);
  if (inputs_.states != nullptr) inputs_.states->save_if_due(tick);
}

// A row and its inputs: both or none.
bool Recorder::push(std::span<const double> head, std::span<const double> row) noexcept {
  if (inputs_.pieces == nullptr) return ring_->try_push(head, row);
  const std::span<const std::span<const double>> pieces = inputs_.pieces->gather();
  if (inputs_ring_ != nullptr) {
    return ring_->free() >= head.size() + row.size() && inputs_ring_->try_push_all(pieces) &&
           ring_->try_push(head, row);
  }
  pushed_.assign({head, row});  // within what is reserved
  pushed_.insert(pushed_.end(), pieces.begin(), pieces.end());
  return ring_->try_push_all(pushed_);
}

bool Recorder::drain() {
  if (!in_place_.row.empty()) {
    put_row(in_place_.tick, in_place_.time_ns, in_place_.row);
    in_place_.row = {};
  }
  const std::size_t row_size = head_size + signal_count_ + (inputs_ring_ ? 0 : word_count_);
  for (std::size_t waiting = ring_ ? ring_->size() / row_size : 0; waiting > 0; --waiting) {
    take_row();
    ring_->drop(row_size);
    if (inputs_ring_) inputs_ring_->drop(word_count_);
  }
  if (inputs_.behaviors != nullptr) take_behavior_inputs();
  EngineStates::Saved saved;
  if (inputs_.states != nullptr && inputs_.states->take(saved)) {
    flight_->state(saved);
    inputs_.states->done();
  }
  take_events(end_of_time_ns);
  take_faults();
  report_drops();
  if (flight_) flight_->step();
  return error().empty();
}

void Recorder::take_row() {
  std::uint64_t tick = 0;
  std::int64_t time_ns = 0;
  std::memcpy(&tick, &ring_->peek(0), sizeof tick);
  std::memcpy(&time_ns, &ring_->peek(1), sizeof time_ns);
  ring_->copy_out(head_size, row_);
  const bool behind = inputs_ring_ == nullptr;
  const Rows& from = behind ? *ring_ : *inputs_ring_;
  const std::size_t first = behind ? head_size + signal_count_ : 0;
  for (std::size_t i = 0; i < word_count_; ++i) std::memcpy(&words_[i], &from.peek(first + i), sizeof words_[i]);
  put_row(tick, time_ns, row_);
}

void Recorder::put_row(std::uint64_t tick, std::int64_t time_ns, std::span<const double> row) {
  take_events(time_ns);
  if (tick > last_tick_) period_ns_ = (time_ns - last_time_ns_) / static_cast<std::int64_t>(tick - last_tick_);
  last_tick_ = tick;
  last_time_ns_ = time_ns;
  if (flight_) flight_->row(tick, time_ns, row, words_);
  if (!opened_ || (!is_open() && error().empty())) return;  // closed, or not yet
  ++rows_;
  if (!file_->row(tick, time_ns, row)) ++lost_;
  if (encoder_) take_inputs(tick, time_ns, row);
}

void Recorder::take_inputs(std::uint64_t tick, std::int64_t time_ns, std::span<const double> row) {
  if (!encoder_->add(tick, time_ns, words_, row)) {
    put_inputs();
    (void)encoder_->add(tick, time_ns, words_, row);
  }
  if (encoder_->full()) put_inputs();
}

// A failing file is told by error().
void Recorder::put_inputs() {
  if (!encoder_ || encoder_->ticks() == 0) return;
  message_.clear();
  encoder_->encode(message_);
  if (is_open()) (void)file_->inputs(message_.bytes(), encoder_->time_ns());
}

void Recorder::take_behavior_inputs() {
  const bool flies = flight_ && flight_->takes_inputs();
  message_.clear();
  for_file_.clear();
  for_flight_.clear();
  inputs_.behaviors->take(message_);
  sorter_.sort(message_.bytes(), inputs_.in_files ? &for_file_ : nullptr, flies ? &for_flight_ : nullptr);
  if (for_file_.size() > 0 && is_open()) (void)file_->behavior_inputs(for_file_.bytes(), last_time_ns_);
  if (for_flight_.size() > 0) flight_->behavior_inputs(for_flight_.bytes());
  if (inputs_.decisions == nullptr) return;
  message_.clear();
  inputs_.decisions->take(message_);
  if (message_.size() > 0 && is_open()) (void)file_->decision_inputs(message_.bytes(), last_time_ns_);
}

void Recorder::take_events(std::int64_t until_ns) {
  while (events_.pop(until_ns, event_)) write_event(event_);
}

void Recorder::write_event(const Event& event) {
  // A file that failed is told by error(); there is nothing else to do about it here.
  if (is_open()) (void)file_->event(event);
  if (flight_) flight_->event(event);
}

// Faults know their tick; its time is reckoned from the newest row.
void Recorder::take_faults() {
  for (Fault fault; faults_.try_pop(fault);) {
    const std::int64_t time_ns = last_time_ns_ + static_cast<std::int64_t>(fault.tick - last_tick_) * period_ns_;
    if (is_open()) (void)file_->fault(fault, time_ns);
    if (flight_) flight_->fault(fault, time_ns);
  }
}

void Recorder::timing(const std::string& json, std::int64_t time_ns) {
  if (is_open()) (void)file_->timing(json, time_ns);
}

void Recorder::report_drops() {
  const std::uint32_t drops = dropped() + dropped_events();
  if (drops == reported_drops_ || !is_open()) return;
  Event event;
  event.severity = BehaviorLog::Severity::warning;
  event.transition.time_ns = last_time_ns_;
  event.transition.behavior = "recorder";
  event.text = std::to_string(dropped()) + " rows and " + std::to_string(dropped_events()) +
               " events so far are not in this record: its writer was too slow";
  (void)file_->event(event);
  reported_drops_ = drops;
}

// With what the recorder knows of the file.
void Recorder::complete() {
  (void)drain();
  put_inputs();
  if (!is_open() || !error().empty()) return;
  (void)file_->describe("recorder", {{"rows", std::to_string(rows_)},
                                     {"dropped_rows", std::to_string(dropped())},
                                     {"dropped_events", std::to_string(dropped_events())}});
}

bool Recorder::close() {
  complete();
  return file_->close();
}

bool Recorder::go_on_in(const std::string& path) {
  complete();
  (void)file_->close();
  return open_new(path);
}

}  // namespace kadans
