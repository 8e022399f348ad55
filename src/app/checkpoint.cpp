#include "checkpoint.h"

#include <charconv>
#include <cmath>

#include "kadans/signal/input_error.h"

namespace kadans {
namespace {

constexpr const char* metadata_name = "checkpoint";

template <typename Number>
Number number_of(const TextMap& facts, const char* name, int base, const std::string& file) {
  const auto found = facts.find(name);
  Number number{};
  if (found != facts.end()) {
    const std::string& text = found->second;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), number, base);
    if (error == std::errc{} && stop == text.data() + text.size()) return number;
  }
  throw InputError({.file = file, .message = std::string("is a damaged checkpoint: no ") + name});
}

}  // namespace

void write_checkpoint(const Checkpoint& checkpoint, const std::string& file) {
  McapWriter writer;
  const TextMap facts{{"tick", std::to_string(checkpoint.at.ticks)},
                      {"time_ns", std::to_string(checkpoint.at.time_ns)},
                      {"state_hash", hash_text(checkpoint.at.state_hash)},
                      {"hashes", marks_text(checkpoint.trail)}};
  const bool written =
      writer.open(file) && write_inputs(writer, checkpoint.inputs) && writer.add_metadata(metadata_name, facts);
  if (!writer.close() || !written) throw InputError({.message = writer.error()});
}

Checkpoint read_checkpoint(const std::string& file) {
  McapReader reader(file);
  McapMessage message;
  while (reader.next(message)) {
  }
  Checkpoint checkpoint;
  const auto found = reader.metadata().find(metadata_name);
  if (found == reader.metadata().end()) {
    throw InputError({.file = file,
                      .message = "is no checkpoint" + (reader.complete() ? "" : ": " + reader.problem()) +
                                 "; kadans sim --checkpoint writes one"});
  }
  const TextMap& facts = found->second;
  checkpoint.inputs = read_inputs(reader, file);
  checkpoint.at = {number_of<std::uint64_t>(facts, "tick", 10, file),
                   number_of<std::int64_t>(facts, "time_ns", 10, file),
                   number_of<std::uint64_t>(facts, "state_hash", 16, file)};
  if (const auto hashes = facts.find("hashes"); hashes != facts.end()) checkpoint.trail = marks_of(hashes->second);
  return checkpoint;
}

CheckpointOrder parse_checkpoint(const std::string& text) {
  const std::size_t equals = text.find('=');
  CheckpointOrder order;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + std::min(equals, text.size()), order.at_s);
  if (equals == std::string::npos || error != std::errc{} || stop != text.data() + equals || !(order.at_s > 0) ||
      equals + 1 == text.size())
    throw InputError(
        {.file = "--checkpoint", .message = "'" + text + "' must be SECONDS=FILE, such as 2.5=crouched.mcap"});
  order.file = text.substr(equals + 1);
  return order;
}

void CheckpointWriter::between_ticks(const RunMark& mark) {
  trail_.between_ticks(mark);
  std::erase_if(orders_, [&](const CheckpointOrder& order) {
    if (mark.time_ns < std::llround(order.at_s * 1e9)) return false;
    write_checkpoint({inputs_, mark, trail_.marks()}, order.file);
    return true;
  });
}

}  // namespace kadans
