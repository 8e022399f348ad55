
#include "flight_recorder.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <zstd.h>

#include "kadans/signal/status.h"

namespace kadans {
namespace {

constexpr int compression_level = 1;

// `value_of(row)`, as differences, the lowest bytes of all rows first. Returns what is behind.
template <std::unsigned_integral T, typename Value>
std::byte* put_column(std::byte* to, std::size_t rows, Value value_of) {
  T before = 0;
  for (std::size_t row = 0; row < rows; ++row) {
    const T value = value_of(row);
    const T step = static_cast<T>(value - before);
    before = value;
    for (std::size_t byte = 0; byte < sizeof(T); ++byte)
      to[byte * rows + row] = static_cast<std::byte>(step >> (8 * byte) & 0xffU);
  }
  return to + rows * sizeof(T);
}

template <std::unsigned_integral T, typename Take>
const std::byte* take_column(const std::byte* from, std::size_t rows, Take take) {
  T value = 0;
  for (std::size_t row = 0; row < rows; ++row) {
    T step = 0;
    for (std::size_t byte = 0; byte < sizeof(T); ++byte)
      step = static_cast<T>(step | static_cast<T>(std::to_integer<T>(from[byte * rows + row]) << (8 * byte)));
    value = static_cast<T>(value + step);
    take(row, value);
  }
  return from + rows * sizeof(T);
}

// A row in a block: its tick, its time, its signals.
std::size_t row_bytes(std::size_t signals) noexcept { return 2 * sizeof(std::uint64_t) + signals * sizeof(float); }

// What inputs need beside the packed blocks: the encoder's, and a block before it is packed, and packed.
std::size_t input_bytes(const FlightSettings& settings) {
  if (!settings.inputs) return 0;
  const std::size_t needed = 2 * (InputEncoder::bytes_max(*settings.inputs) + settings.inputs->state_bytes);
  return std::min(needed, settings.bytes / 2);
}

}  // namespace

FlightMemory::FlightMemory(std::size_t signals, const FlightSettings& settings)
    : signals_(signals),
      kept_ns_(std::llround(settings.kept_s * 1e9)),
      store_(settings.bytes - input_bytes(settings)),
      planes_(block_rows * row_bytes(signals)),
      packer_(compression_level, planes_.size()),
      held_(signals) {
  for (SignalId id = 0; id < signals; ++id)
    rates_[settings.every_ticks.empty() ? 1 : settings.every_ticks[id]].push_back(id);
  if (settings.inputs) encoder_ = std::make_unique<InputEncoder>(*settings.inputs, std::vector<bool>{});
  ticks_.reserve(block_rows);
  times_.reserve(block_rows);
  values_.reserve(block_rows * signals);
}

void FlightMemory::add(std::uint64_t tick, std::int64_t time_ns, std::span<const double> row,
                       std::span<const std::uint64_t> inputs) {
  if (encoder_ != nullptr && !encoder_->add(tick, time_ns, inputs, {})) {
    seal();
    (void)encoder_->add(tick, time_ns, inputs, {});
  }
  ticks_.push_back(tick);
  times_.push_back(static_cast<std::uint64_t>(time_ns));
  for (const auto& [every_ticks, signals] : rates_) {
    if (tick % every_ticks != 0) continue;
    for (const SignalId id : signals) held_[id] = static_cast<float>(row[id]);
  }
  values_.insert(values_.end(), held_.begin(), held_.end());
  if (ticks_.size() == block_rows) seal();
}

void FlightMemory::add_state(const EngineStates::Saved& state) {
  const std::size_t length = states_.size(), begin = length + sizeof(std::uint32_t);
  states_.put(std::uint32_t{0});
  put_state(state, states_);
  states_.set(length, static_cast<std::uint32_t>(states_.size() - begin));
}

void FlightMemory::seal() {
  const std::size_t rows = ticks_.size();
  if (rows == 0 && behaviors_.size() + states_.size() == 0) return;
  if (encoder_ != nullptr && rows > 0) encoder_->encode(inputs_);
  if (rows > 0) last_ns_ = static_cast<std::int64_t>(times_.back());
  while (!blocks_.empty() && blocks_.front().last_ns < last_ns_ - kept_ns_) drop_oldest_whole();
  Block block{.rows = rows,
              .last_ns = last_ns_,
              .inputs = static_cast<std::uint32_t>(inputs_.size()),
              .behaviors = static_cast<std::uint32_t>(behaviors_.size()),
              .states = static_cast<std::uint32_t>(states_.size())};
  const std::size_t behind = inputs_.size() + behaviors_.size() + states_.size();
  planes_.resize(std::max({planes_.size(), rows * row_bytes(signals_), behind}));
  std::byte* to = planes_.data();
  for (ByteWriter* part : {&inputs_, &behaviors_, &states_}) {
    to = std::ranges::copy(part->bytes(), to).out;
    part->clear();
  }
  block.lost = !pack(behind, block.taken);
  to = put_column<std::uint64_t>(planes_.data(), rows, [&](std::size_t row) { return ticks_[row]; });
  to = put_column<std::uint64_t>(to, rows, [&](std::size_t row) { return times_[row]; });
  for (std::size_t i = 0; i < signals_; ++i) {
    to = put_column<std::uint32_t>(
        to, rows, [&](std::size_t row) { return std::bit_cast<std::uint32_t>(values_[row * signals_ + i]); });
  }
  if (!block.lost && !pack(rows * row_bytes(signals_), block.signals)) {
    block.lost = true;
    store_.drop(block.taken);
  }
  signal_bytes_ += block.signals.size;
  ticks_.clear();
  times_.clear();
  values_.clear();
  blocks_.push_back(block);
  ++end_;
}

// The first bytes of planes_, in the place of what is older. False: out of memory, or too large.
bool FlightMemory::pack(std::size_t bytes, Part& part) {
  if (bytes == 0) return true;
  const std::span<const std::byte> packed = packer_.pack(std::span(planes_).first(bytes));
  if (packed.empty() || packed.size() > store_.bytes()) return false;
  while (!store_.has_room(packed.size()) && !blocks_.empty()) drop_oldest();
  if (!store_.has_room(packed.size())) return false;
  part = store_.put(packed);
  return true;
}

// Signals, while there are many, because a repetition computes them again; else all of a block.
void FlightMemory::drop_oldest() noexcept {
  if (first() < spare_before_) return drop_oldest_whole();
  const auto oldest = std::ranges::find_if(blocks_, [](const Block& block) { return block.signals.size > 0; });
  if (encoder_ == nullptr || oldest == blocks_.end() || signal_bytes_ < store_.bytes() / 3) return drop_oldest_whole();
  signal_bytes_ -= oldest->signals.size;
  store_.drop(oldest->signals);
}

void FlightMemory::drop_oldest_whole() noexcept {
  signal_bytes_ -= blocks_.front().signals.size;
  store_.drop(blocks_.front().signals);
  store_.drop(blocks_.front().taken);
  blocks_.pop_front();
}

FlightMemory::Store::Store(std::size_t bytes)
    : pages_(bytes / (page_bytes + sizeof(std::uint32_t)) * page_bytes), next_(pages_.size() / page_bytes) {
  free_ = next_.size();
  std::iota(next_.begin(), next_.end(), 1U);
}

FlightMemory::Part FlightMemory::Store::put(std::span<const std::byte> bytes) {
  const Part part{.page = first_free_, .size = static_cast<std::uint32_t>(bytes.size())};
  for (; !bytes.empty(); bytes = bytes.subspan(std::min(page_bytes, bytes.size()))) {
    std::ranges::copy(bytes.first(std::min(page_bytes, bytes.size())), pages_.data() + first_free_ * page_bytes);
    first_free_ = next_[first_free_];
    --free_;
  }
  return part;
}

std::vector<std::byte> FlightMemory::Store::get(Part part) const {
  std::vector<std::byte> bytes(part.size);
  std::span<std::byte> left = bytes;
  for (std::uint32_t page = part.page; !left.empty(); page = next_[page]) {
    const std::size_t count = std::min(page_bytes, left.size());
    std::copy_n(pages_.data() + page * page_bytes, count, left.data());
    left = left.subspan(count);
  }
  return bytes;
}

void FlightMemory::Store::drop(Part& part) noexcept {
  const std::size_t pages = pages_in(part.size);
  if (pages == 0) return;
  std::uint32_t last = part.page;
  for (std::size_t i = 1; i < pages; ++i) last = next_[last];
  next_[last] = std::exchange(first_free_, part.page);
  free_ += pages;
  part = {};
}

namespace {

// Empty: the bytes do not unpack to so many.
std::vector<std::byte> unpacked(std::span<const std::byte> packed, std::size_t size) {
  std::vector<std::byte> bytes(size);
  if (ZSTD_decompress(bytes.data(), size, packed.data(), packed.size()) != size) bytes.clear();
  return bytes;
}

}  // namespace

bool FlightMemory::read(std::uint64_t block, Rows& rows) const {
  if (block < first() || block >= end_) return false;
  const Block& found = blocks_[static_cast<std::size_t>(block - first())];
  if (found.lost) return false;
  rows = {.last_ns = found.last_ns};
  if (found.taken.size > 0) {
    const std::vector<std::byte> taken =
        unpacked(store_.get(found.taken), std::size_t{found.inputs} + found.behaviors + found.states);
    if (taken.empty()) return false;
    ByteReader reader(taken);
    const auto take = [&reader](std::size_t size) {
      const std::span<const std::byte> bytes = reader.take_bytes(size);
      return std::vector<std::byte>(bytes.begin(), bytes.end());
    };
    rows.inputs = take(found.inputs);
    rows.behaviors = take(found.behaviors);
    while (reader.left() > 0) rows.states.push_back(take(reader.take<std::uint32_t>()));
  }
  if (found.signals.size == 0) return true;
  const std::vector<std::byte> planes = unpacked(store_.get(found.signals), found.rows * row_bytes(signals_));
  if (planes.empty()) return false;
  rows.ticks.resize(found.rows);
  rows.times_ns.resize(found.rows);
  rows.values.resize(found.rows * signals_);
  const std::byte* from = take_column<std::uint64_t>(
      planes.data(), found.rows, [&](std::size_t row, std::uint64_t tick) { rows.ticks[row] = tick; });
  from = take_column<std::uint64_t>(from, found.rows, [&](std::size_t row, std::uint64_t time_ns) {
    rows.times_ns[row] = static_cast<std::int64_t>(time_ns);
  });
  for (std::size_t i = 0; i < signals_; ++i) {
    from = take_column<std::uint32_t>(from, found.rows, [&](std::size_t row, std::uint32_t bits) {
      rows.values[row * signals_ + i] = static_cast<double>(std::bit_cast<float>(bits));
    });
  }
  return true;
}

std::uint64_t FlightMemory::rows() const noexcept {
  std::uint64_t rows = 0;
  for (const Block& block : blocks_) rows += block.lost || block.signals.size > 0 ? block.rows : 0;
  return rows;
}

std::size_t FlightMemory::packed_bytes() const noexcept {
  std::size_t bytes = 0;
  for (const Block& block : blocks_) bytes += std::size_t{block.taken.size} + block.signals.size;
  return bytes;
}

namespace {

// A dump holds what the memory does.
RecorderSettings dump_settings(RecorderSettings record, const FlightSettings& memory) {
  record.every_ticks = memory.every_ticks;
  record.precision = Precision::single;
  record.file.chunk_bytes = std::size_t{256} << 10U;  // it is made while the run goes on: little memory
  return record;
}

}  // namespace

FlightRecorder::FlightRecorder(const SignalTable& signals, const FlightSettings& settings,
                               const RecorderSettings& record)
    : signals_(signals),
      record_(dump_settings(record, settings)),
      kept_ns_(std::llround(settings.kept_s * 1e9)),
      layout_(settings.inputs),
      memory_(signals.size(), settings) {
  for (SignalId id = 0; id < signals.size(); ++id) {
    const std::string& name = signals.info(id).name;
    if (name == "safety.level" || name.ends_with(".safety.level")) levels_.push_back({id});
  }
}

void FlightRecorder::row(std::uint64_t tick, std::int64_t time_ns, std::span<const double> row,
                         std::span<const std::uint64_t> inputs) {
  memory_.add(tick, time_ns, row, inputs);
  last_ns_ = time_ns;
  for (Level& level : levels_) watch(time_ns, std::exchange(level.now, row[level.signal]), row[level.signal]);
}

void FlightRecorder::watch(std::int64_t time_ns, double before, double level) noexcept {
  constexpr auto hold = static_cast<double>(SafetyLevel::hold);
  const bool latches = level >= hold && before < hold;
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
  if (layout_) dump_->add_inputs(*layout_);
  to_write_ = happenings_;
  next_block_ = memory_.first();
  end_block_ = memory_.end();
  due_rows_ = memory_.rows();
  written_rows_ = 0;
  return true;
}

void FlightRecorder::step() {
  if (!busy()) return;
  for (std::size_t i = 0; i < blocks_a_step && next_block_ < end_block_; ++i) {
    next_block_ = std::max(next_block_, memory_.first());
    const bool kept = memory_.read(next_block_++, rows_);
    memory_.spare_before(next_block_);
    if (!kept) continue;
    const std::size_t signals = signals_.size();
    written_rows_ += rows_.ticks.size();
    for (std::size_t row = 0; row < rows_.ticks.size(); ++row) {
      write_happenings(rows_.times_ns[row]);
      (void)dump_->row(rows_.ticks[row], rows_.times_ns[row],
                       std::span<const double>(rows_.values).subspan(row * signals, signals));
    }
    write_happenings(rows_.last_ns);
    if (layout_) write_inputs();
  }
  if (next_block_ < end_block_) return;
  write_happenings(std::numeric_limits<std::int64_t>::max());
  (void)dump_->describe("recorder", {{"rows", std::to_string(written_rows_)},
                                     {"dropped_rows", std::to_string(due_rows_ - written_rows_)}});
  if (!dump_->close()) error_ = dump_->error();
  dump_.reset();
  rows_ = {};
  memory_.spare_before(0);
  ++dumps_;
}

// Behind the rows of their ticks.
void FlightRecorder::write_inputs() {
  const std::int64_t time_ns = rows_.last_ns;
  if (!rows_.inputs.empty()) (void)dump_->inputs(rows_.inputs, time_ns);
  if (!rows_.behaviors.empty()) (void)dump_->behavior_inputs(rows_.behaviors, time_ns);
  for (const std::vector<std::byte>& state : rows_.states) (void)dump_->state(state, time_ns);
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
