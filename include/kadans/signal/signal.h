// The signal table: every recorded quantity, declared once with a name and a unit. The control thread gathers all of
// them into one row of numbers per tick. Recorder, checks, viewers and scripts know them by name.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <variant>
#include <vector>

namespace kadans {

using SignalId = std::uint32_t;

struct Signal {
  std::string name;  // "joint.l_knee.position_rad": topic, part, quantity with its unit
  std::string unit;
  std::string doc;  // one sentence
  // What changes over seconds, such as a temperature: records hold it this often unless they are told otherwise. 0: in
  // each tick.
  double slow_Hz = 0;
};

// Tells signals apart by name in another process too, whose table may have other numbers.
constexpr std::int64_t signal_key(std::string_view name) noexcept {
  std::uint64_t hash = 0xcbf29ce484222325;  // FNV-1a
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  return static_cast<std::int64_t>(hash);
}

class SignalTable {
 public:
  // Before the loop. The source is read by the control thread and must outlive the table's use.
  // Throws std::invalid_argument on a name that is taken.
  SignalId add(Signal signal, const double* source);
  SignalId add(Signal signal, const bool* source);
  SignalId add(Signal signal, const std::uint8_t* source);
  SignalId add(Signal signal, const std::uint32_t* source);
  SignalId add(Signal signal, const std::atomic<std::uint32_t>* source);  // written by another thread

  // Before the loop: from now on the signal is read there. For a repeated run, whose plant is a record.
  void read_from(SignalId id, const double* source);
  // Control thread. row.size() == size(), asserted; booleans become 0 and 1. No allocation.
  void gather(std::span<double> row) const noexcept;
  // Control thread: one signal as it is now, which may be newer than the last row. id < size().
  double read(SignalId id) const noexcept;

  // Any thread: the declarations do not change once the loop runs.
  std::optional<SignalId> find(std::string_view name) const;
  // Any thread; allocates nothing.
  std::optional<SignalId> find_key(std::int64_t key) const noexcept;
  // Throws std::out_of_range on an unknown id.
  const Signal& info(SignalId id) const { return infos_.at(id); }
  std::size_t size() const noexcept { return infos_.size(); }
  std::vector<std::string> names() const;

 private:
  SignalId add_info(Signal signal);

  template <typename T>
  struct Source {
    SignalId id;
    const T* value;
  };
  template <typename T>
  SignalId add_to(std::vector<Source<T>>& sources, Signal signal, const T* source);

  // The source of a signal, whatever its type.
  using AnySource = std::variant<const double*, const bool*, const std::uint8_t*, const std::uint32_t*,
                                 const std::atomic<std::uint32_t>*>;
  std::vector<Signal> infos_;
  std::vector<AnySource> sources_;  // by id
  std::unordered_map<std::string, SignalId> ids_;
  std::unordered_map<std::int64_t, SignalId> keys_;
  // Doubles that are neighbours in memory and in the row, by their number less 1: each time one copy of fixed length.
  static constexpr std::size_t run_max = 8;
  std::array<std::vector<Source<double>>, run_max> runs_;
  std::size_t last_run_ = 0;  // the length of the run that was added to last
  std::vector<Source<bool>> bools_;
  std::vector<Source<std::uint8_t>> choices_;
  std::vector<Source<std::uint32_t>> counts_;
  std::vector<Source<std::atomic<std::uint32_t>>> shared_;
};

}  // namespace kadans
