// The kernel's input events, as a device gives them (Documentation/input/input.rst), and recordings of them.
//
// A recording is one of two things:
//   text   as `evemu-record /dev/input/eventN` writes it: lines "A: <axis> <min> <max> ..." (ranges; the axis in
//          hexadecimal) and "E: <seconds> <type> <code> <value>" (types and codes in hexadecimal); "#" begins a
//          comment; N, I, P, B, L and S lines are passed over;
//   bytes  as `cat /dev/input/eventN` writes them: struct input_event of this machine, one after the other. They do not
//          tell the ranges of the axes; the settings must.
// Time 0 is the first event's.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace kadans {

struct StickEvent {
  std::int64_t time_ns = 0;
  std::uint16_t type = 0, code = 0;
  std::int32_t value = 0;
};

struct StickRange {
  double min = 0, max = 0;  // both 0: not known
};
using StickRanges = std::array<StickRange, 64>;  // by the axis' code

struct StickRecording {
  std::vector<StickEvent> events;
  StickRanges ranges{};
};

// Throws InputError with the line, or the byte, that is wrong.
StickRecording read_stick_recording(const std::filesystem::path& file);
StickRecording read_stick_recording(const std::string& content, const std::string& file);

// Decodes the bytes that a read of a device returned. Returns the number of complete events. Times are the kernel's, -1
// where a time is impossible.
std::size_t decode_stick_events(std::span<const std::byte> bytes, std::span<StickEvent> events) noexcept;

}  // namespace kadans
