// What the behavior thread, or the supervisor's with its decisions, takes from outside of its own state, in the order
// in which it takes it. One implementation writes it into the record of a run (telemetry), the other gives it to a run
// that repeats the record (app). Without either, nothing is asked.
//
// A behavior tick sees the snapshot of one control tick, so the number of that tick says all of it. What people ask
// comes between two ticks. Four things come in the middle of a tick, by the moment: values that low levels of control
// objects have just given (hand_over.h), the newest value of a parameter, a limit of time, and the text of a file.
//
// Behavior thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "kadans/signal/command.h"
#include "kadans/signal/status.h"
#include "signal/byte_order.h"

namespace kadans {

class BehaviorInputs {
 public:
  // Kinds of what people ask of the host, which knows how to read the bytes. Decisions are asked questions, too, and
  // take more: what is seen of the world and what plays, in each tick; the files again; a message of another robot; and
  // what they decided in the tick, by which a repetition is compared. `taken_over`: the process in which they ran is
  // gone, and another one goes on with this tick, from what the last one left.
  enum class Asked : std::uint8_t { order, question, note, seen, plays, reload, heard, decided, taken_over };
  static constexpr Asked last_asked = Asked::taken_over;

  virtual ~BehaviorInputs() = default;
  BehaviorInputs() = default;
  BehaviorInputs(const BehaviorInputs&) = delete;
  BehaviorInputs& operator=(const BehaviorInputs&) = delete;

  virtual void tick_begins(const Snapshot& /*snapshot*/, std::int64_t /*time_ns*/) { looks_ = 0; }
  virtual void tick_ends() { looks_ = 0; }
  // A transaction went into the queue: `batch` begins with its header. `in_tick`: a behavior sent it.
  virtual void sent(std::span<const Command> batch, bool in_tick) noexcept = 0;
  // The high level of a control object finds a value that is newer than its snapshot.
  virtual void found_newer(std::uint32_t /*storage*/, std::span<const std::byte> /*value*/) {}
  // A script reads a parameter, whose newest value is this; returns the value that counts.
  virtual double parameter(double newest) noexcept = 0;
  // A script's budget is looked at. `over` says whether its time is over; returns what counts.
  virtual bool time_is_over(bool (*over)(void*) noexcept, void* budget) noexcept = 0;
  // A script's file was read.
  virtual void file_read(const std::string& /*path*/, std::string_view /*text*/) {}
  virtual void asked(Asked /*kind*/, std::span<const std::byte> /*bytes*/) { looks_ = 0; }

  // From a process of its own to the one that writes the record: what was told since, as bytes that are passed on
  // there. False: they are rubbish.
  virtual void tell_on(ByteWriter& /*told*/) {}
  [[nodiscard]] virtual bool pass_on(std::span<const std::byte> /*told*/) { return true; }

 protected:
  std::uint32_t looks_ = 0;  // at the clock, since a tick began or ended or somebody asked
};

// Tells what was asked, as put(ByteWriter&) writes it; nullptr: to nobody, and nothing is written.
template <typename Put>
void tell_asked(BehaviorInputs* inputs, BehaviorInputs::Asked kind, Put put) {
  if (inputs == nullptr) return;
  ByteWriter bytes;
  put(bytes);
  inputs->asked(kind, bytes.bytes());
}

}  // namespace kadans
