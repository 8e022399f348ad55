#include "input_reader.h"

#include <algorithm>
#include <bit>
#include <filesystem>
#include <limits>
#include <sstream>
#include <utility>

#include "kadans/signal/input_error.h"
#include "kadans/signal/nearest_name.h"
#include "record_rows.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

constexpr std::size_t rows_max = 20'000;  // that wait for the inputs of their ticks
constexpr double not_known = std::numeric_limits<double>::quiet_NaN();

}  // namespace

RecordFiles::RecordFiles(const std::string& record) : file_(record), reader_(std::make_unique<McapReader>(record)) {}

bool RecordFiles::go_on() {
  namespace fs = std::filesystem;
  const auto facts = reader_->metadata().find("goes_on");
  if (!reader_->complete() || facts == reader_->metadata().end() || !facts->second.contains("file")) return false;
  const fs::path name = facts->second.at("file"), next = fs::path(file_).parent_path() / name;
  std::error_code none;
  if (name.empty() || name != name.filename() || !fs::is_regular_file(next, none)) return false;
  if (!read_.insert(fs::path(file_).filename().string()).second || read_.contains(name.string())) return false;
  try {
    reader_ = std::make_unique<McapReader>(next.string());
  } catch (const InputError&) {  // no record
    return false;
  }
  file_ = next.string();
  return true;
}

TopicReader::TopicReader(const std::string& record, std::vector<std::string> topics)
    : files_(record), topics_(std::move(topics)) {}

bool TopicReader::next(McapMessage& message) {
  do {
    while (files_.reader().next(message)) {
      const std::string& topic = files_.reader().channels().at(message.channel).topic;
      if (std::ranges::find(topics_, topic) != topics_.end()) return true;
    }
  } while (files_.go_on());
  return false;
}

TickReader::TickReader(const std::string& record) : files_(record) {}

bool TickReader::stop(const std::string& why) {
  if (problem_.empty()) problem_ = why.starts_with(files_.file()) ? why : files_.file() + ": " + why;
  return false;
}

bool TickReader::next(TickTaken& taken) {
  while (ticks_.empty()) {
    if (!problem_.empty() || !read()) return false;
  }
  taken = std::move(ticks_.front());
  ticks_.pop_front();
  if (next_tick_ && taken.tick != *next_tick_)
    return stop("the inputs of " + std::to_string(taken.tick - *next_tick_) + " ticks are missing from tick " +
                std::to_string(*next_tick_) + " on");
  next_tick_ = taken.tick + 1;
  row_ = rows_[taken.tick - first_];
  for (; first_ + InputEncoder::lag_max < taken.tick; ++first_) rows_.pop_front();  // what comes may be near to them
  return true;
}

bool TickReader::read() {
  McapMessage message;
  if (!files_.reader().next(message)) {
    if (!files_.reader().complete()) return stop(files_.reader().problem());
    layout_.reset();
    topics_.clear();
    return files_.go_on();
  }
  if (!layout_ && !learn()) return false;
  if (files_.reader().channels().at(message.channel).topic == inputs_topic) return take_inputs(message);
  take_row(message);
  if (rows_.size() > rows_max) return stop("it has rows without the inputs of their ticks");
  return true;
}

bool TickReader::learn() {
  const auto found = files_.reader().metadata().find(inputs_metadata);
  if (found == files_.reader().metadata().end()) return stop("it holds no inputs of its ticks");
  const std::vector<std::string> before = std::move(names_);
  layout_ = InputLayout::of(found->second);
  names_.clear();
  std::istringstream names(fact_in(found->second, "names"));
  for (std::string name; std::getline(names, name); names_.push_back(name))
    numbers_[name] = static_cast<std::uint32_t>(names_.size());
  if (!before.empty() && before != names_) return stop("it is no part of the same run");
  if (!layout_) return stop("its inputs are of another version of kadans");
  decoder_ = std::make_unique<InputDecoder>(*layout_);
  return true;
}

void TickReader::take_row(const McapMessage& message) {
  const auto [known, added] = topics_.try_emplace(message.channel);
  std::vector<std::uint32_t>& numbers = known->second;
  if (added) {
    for (const std::string& name : names_of(topic_of(files_.reader(), message.channel).signals)) {
      const auto number = numbers_.find(name);
      numbers.push_back(number == numbers_.end() ? std::numeric_limits<std::uint32_t>::max() : number->second);
    }
  }
  if (numbers.empty()) return;
  values_.resize(numbers.size());
  if (!read_cdr(message.payload, values_) || !reach(message.sequence)) return;
  for (std::size_t row = message.sequence - first_; row < rows_.size(); ++row) {
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      if (numbers[i] < names_.size()) rows_[row][numbers[i]] = values_[i];
    }
  }
}

// There are rows up to this tick: one without messages is as the one before it.
bool TickReader::reach(std::uint64_t tick) {
  if (rows_.empty()) {
    first_ = tick;
    rows_.emplace_back(names_.size(), not_known);
  }
  if (tick < first_ || tick - first_ > rows_max) return false;
  while (first_ + rows_.size() <= tick) rows_.push_back(rows_.back());
  return true;
}

bool TickReader::take_inputs(const McapMessage& message) {
  ByteReader head(message.payload);
  const auto first = head.take<std::uint64_t>();
  const auto count = head.take<std::uint32_t>();
  const bool reached =
      head.ok() && count > 0 && count <= InputEncoder::ticks_max && reach(first) && reach(first + count - 1);
  if (reached && decoder_->decode(message.payload, *this, ticks_)) return true;
  ticks_.clear();
  return stop(printed("its inputs are damaged from %.3f s on", 1e-9 * static_cast<double>(message.time_ns)));
}

std::optional<std::uint64_t> TickReader::bits(std::uint64_t tick, std::uint32_t signal) const {
  if (tick < first_ || tick - first_ >= rows_.size() || signal >= names_.size()) return std::nullopt;
  return std::bit_cast<std::uint64_t>(rows_[tick - first_][signal]);
}

const EngineStates::Saved* StateReader::get() {
  if (!std::exchange(read_, true)) there_ = reader_.next(message_) && take_state(message_.payload, found_, saved_);
  return there_ ? &saved_ : nullptr;
}

bool BehaviorInputReader::next(BehaviorInput& input) {
  while (at_ == message_.size()) {
    McapMessage message;
    if (damaged_ || !reader_.next(message)) return false;
    message_.assign(message.payload.begin(), message.payload.end());
    at_ = 0;
  }
  began_ = at_;
  const std::span<const std::byte> all = message_;
  ByteReader bytes(all.subspan(at_));
  if (std::exchange(any_first_, false)) expected_ = number_of_behavior_input(bytes);
  damaged_ = !take_behavior_input(bytes, expected_, input);
  at_ = damaged_ ? message_.size() : message_.size() - bytes.left();
  return !damaged_;
}

std::span<const std::byte> BehaviorInputReader::bytes() const noexcept {
  return std::span(message_).subspan(began_, at_ - began_);
}

bool TakenTick::read(BehaviorInputReader& reader) {
  *this = {};
  for (BehaviorInput input; reader.next(input);) {
    if (input.kind == BehaviorInput::Kind::tick_begins) {
      snapshot_ = input.snapshot;
      begun_ = true;
    }
    inputs_.push_back(std::move(input));
    end_ = inputs_.size();
    if (inputs_.back().kind == BehaviorInput::Kind::tick_ends) return true;
  }
  return false;
}

void TakenTick::turn_to(std::size_t asked) noexcept {
  const auto is_asked = [this](std::size_t i) { return inputs_[i].kind == BehaviorInput::Kind::asked; };
  moment_ = end_ = asked;
  if (inputs_[asked].how == BehaviorInputs::Asked::decided) {
    while (moment_ > 0 && !is_asked(moment_ - 1)) --moment_;
    return;
  }
  moment_ = ++end_;
  while (end_ < inputs_.size() && !is_asked(end_)) ++end_;
}

double TakenTick::parameter(double newest) noexcept {
  for (std::size_t i = moment_; i < end_; ++i) {
    if (inputs_[i].kind != BehaviorInput::Kind::parameter) continue;
    moment_ = i + 1;
    return inputs_[i].value;
  }
  return newest;
}

bool TakenTick::time_is_over(std::uint32_t look) noexcept {
  for (std::size_t i = moment_; i < end_ && inputs_[i].kind != BehaviorInput::Kind::parameter; ++i) {
    if (inputs_[i].kind != BehaviorInput::Kind::time_over || inputs_[i].number != look) continue;
    moment_ = i + 1;
    return true;
  }
  return false;
}

}  // namespace kadans
