#include "checkpoint.h"

#include <cmath>

#include "app/assembly/assembly.h"
#include "signal/input_file.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

constexpr const char* metadata_name = "checkpoint";
constexpr const char* objects_name = "control_objects";

template <typename Number>
Number fact_of(const TextMap& facts, const char* name, int base, const std::string& file) {
  if (const std::optional<Number> number = number_of<Number>(fact_in(facts, name), base)) return *number;
  refuse(file, std::string("is a damaged checkpoint: no ") + name);
}

}  // namespace

void write_checkpoint(const Checkpoint& checkpoint, const std::string& file) {
  McapWriter writer;
  const TextMap facts{{"tick", std::to_string(checkpoint.at.ticks)},
                      {"time_ns", std::to_string(checkpoint.at.time_ns)},
                      {"state_hash", hash_text(checkpoint.at.state_hash)},
                      {"hashes", marks_text(checkpoint.trail)}};
  const bool written = writer.open(file) && write_inputs(writer, checkpoint.inputs) &&
                       writer.add_metadata(metadata_name, facts) &&
                       writer.add_metadata(objects_name, checkpoint.objects);
  if (!writer.close() || !written) refuse(writer.error());
}

Checkpoint read_checkpoint(const std::string& file) {
  McapReader reader(file);
  McapMessage message;
  while (reader.next(message)) {
  }
  Checkpoint checkpoint;
  const auto found = reader.metadata().find(metadata_name);
  if (found == reader.metadata().end()) {
    refuse(file, "is no checkpoint" + (reader.complete() ? "" : ": " + reader.problem()) +
                     "; kadans sim --checkpoint writes one");
  }
  const TextMap& facts = found->second;
  checkpoint.inputs = read_inputs(reader, file);
  checkpoint.at = {fact_of<std::uint64_t>(facts, "tick", 10, file), fact_of<std::int64_t>(facts, "time_ns", 10, file),
                   fact_of<std::uint64_t>(facts, "state_hash", 16, file)};
  checkpoint.trail = marks_of(fact_in(facts, "hashes"));
  if (const auto objects = reader.metadata().find(objects_name); objects != reader.metadata().end())
    checkpoint.objects = objects->second;
  return checkpoint;
}

TextMap object_states(Assembly& assembly) {
  TextMap states;
  const std::vector<ObjectInfo>& objects = assembly.catalog().objects;
  for (std::uint32_t i = 0; i < objects.size(); ++i) {
    StateHash hash;
    StateBytes hashing = StateBytes::hashing(hash);
    assembly.sets().object(i).pass_state(hashing);
    states[objects[i].name] = hash_text(hash.value());
  }
  for (const auto& other : assembly.others()) {
    for (const auto& [name, hash] : object_states(*other)) states[other->scenario().name + "." + name] = hash;
  }
  return states;
}

std::string differing_objects(const TextMap& checkpoint, const TextMap& now) {
  std::string names;
  for (const auto& [name, hash] : now) {
    const auto found = checkpoint.find(name);
    if (checkpoint.empty() || (found != checkpoint.end() && found->second == hash)) continue;
    names += (names.empty() ? "" : ", ") + name;
  }
  return names;
}

PlannedCheckpoint parse_checkpoint(const std::string& text) {
  const std::size_t equals = text.find('=');
  const std::optional<double> at_s = number_of<double>(std::string_view(text).substr(0, equals));
  if (equals == std::string::npos || !at_s || !(*at_s > 0) || equals + 1 == text.size())
    refuse("--checkpoint", "'" + text + "' must be SECONDS=FILE, such as 2.5=crouched.mcap");
  return {.at_s = *at_s, .file = text.substr(equals + 1)};
}

void CheckpointWriter::between_ticks(const RunMark& mark) {
  trail_.between_ticks(mark);
  std::erase_if(planned_, [&](const PlannedCheckpoint& planned) {
    if (mark.time_ns < std::llround(planned.at_s * 1e9)) return false;
    if (!ordered_.fact().empty()) inputs_.run["events"] = ordered_.fact();
    write_checkpoint({inputs_, mark, trail_.marks(), object_states(assembly_)}, planned.file);
    return true;
  });
}

}  // namespace kadans
