#include "flight_recorder.h"

#include <cmath>
#include <limits>
#include <utility>

#include "kadans/signal/status.h"

namespace kadans {
namespace {

// A dump holds all signals in each tick, in the precision of the memory.
RecorderSettings dump_settings(RecorderSettings record) {
  record.every_ticks.clear();
  record.precision = Precision::single;
  record.file.chunk_bytes = std::size_t{256} << 10U;  // it is made while the run goes on: little memory
  return record;
}

}  // namespace

FlightRecorder::FlightRecorder(const SignalTable& signals, const FlightSettings& settings,
                               const RecorderSettings& record)
    : signals_(signals),
      record_(dump_settings(record)),
      kept_ns_(std::llround(settings.kept_s * 1e9)),
      memory_(signals.size(), settings),
      level_signal_(signals.find("safety.level")) {}

void FlightRecorder::row(std::uint64_t tick, std::int64_t time_ns, std::span<const double> row) {
  memory_.add(tick, time_ns, row);
  last_ns_ = time_ns;
  if (level_signal_) watch(time_ns, row[*level_signal_]);
}

void FlightRecorder::watch(std::int64_t time_ns, double level) noexcept {
  constexpr auto hold = static_cast<double>(SafetyLevel::hold);
  const bool latches = level >= hold && level_ < hold;
  level_ = level;
  if (!latches || !watching_ || latched_ns_) return;
  if (last_latched_ns_ && time_ns < *last_latched_ns_ + kept_ns_) return;
  latched_ns_ = last_latched_ns_ = time_ns;
}

void FlightRecorder::event(const Event& event) {
  Happening happening{event.transition.time_ns, event};
  std::string& text = std::get<Event>(happening.what).text;
  if (text.size() > text_max) text.resize(text_max);
  keep(std::move(happening));
}

void FlightRecorder::fault(const Fault& fault, std::int64_t time_ns) { keep({time_ns, fault}); }

void FlightRecorder::keep(Happening happening) {
  const std::int64_t oldest_ns = happening.time_ns - kept_ns_;
  while (!happenings_.empty() && (happenings_.size() >= events_max || happenings_.front().time_ns < oldest_ns))
    happenings_.pop_front();
  happenings_.push_back(std::move(happening));
}

bool FlightRecorder::begin(const std::string& file) {
  latched_ns_.reset();
  memory_.seal();
  file_ = file;
  error_.clear();
  dump_ = std::make_unique<RecordWriter>(signals_, record_);
  if (!dump_->open(file)) {
    error_ = dump_->error();
    dump_.reset();
    ++dumps_;
    return false;
  }
  to_write_ = happenings_;
  next_block_ = memory_.first();
  end_block_ = memory_.end();
  return true;
}

void FlightRecorder::step() {
  if (!busy()) return;
  for (std::size_t i = 0; i < blocks_a_step && next_block_ < end_block_; ++i) {
    next_block_ = std::max(next_block_, memory_.first());
    if (!memory_.read(next_block_++, rows_)) continue;
    const std::size_t signals = signals_.size();
    for (std::size_t row = 0; row < rows_.ticks.size(); ++row) {
      write_happenings(rows_.times_ns[row]);
      (void)dump_->row(rows_.ticks[row], rows_.times_ns[row],
                       std::span<const double>(rows_.values).subspan(row * signals, signals));
    }
  }
  if (next_block_ < end_block_) return;
  write_happenings(std::numeric_limits<std::int64_t>::max());
  if (!dump_->close()) error_ = dump_->error();
  dump_.reset();
  rows_ = {};
  ++dumps_;
}

void FlightRecorder::write_happenings(std::int64_t until_ns) {
  while (!to_write_.empty() && to_write_.front().time_ns <= until_ns) {
    const Happening& happening = to_write_.front();
    if (const Event* event = std::get_if<Event>(&happening.what)) (void)dump_->event(*event);
    if (const Fault* fault = std::get_if<Fault>(&happening.what)) (void)dump_->fault(*fault, happening.time_ns);
    to_write_.pop_front();
  }
}

void FlightRecorder::finish() {
  while (busy()) step();
}

}  // namespace kadans
