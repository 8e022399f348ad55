// What a run was made of, kept inside its record so that the run can be made again: its facts (scenario, seed,
// duration, what the command line set), the program and its libraries, and the files that it read.
//
// In the file: metadata "run" and "program"; metadata "inputs" with the hash of every file by its path; each text as an
// attachment "inputs/PATH.zst", compressed, that any tool can take out. What is too large or no text (a plug-in, a
// mesh) is known by its hash alone. All of it stands before the first message, so a record cut short still has it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kadans/signal/number_text.h"
#include "kadans/telemetry/mcap_reader.h"
#include "kadans/telemetry/mcap_writer.h"

namespace kadans {

struct InputFile {
  std::string path;  // from the project's root; "beside/x" from the scenario's folder; absolute elsewhere
  std::string hash;  // of its content, 16 hexadecimal digits
  std::optional<std::string> text;
};

struct RunInputs {
  TextMap run;
  TextMap program;
  std::vector<InputFile> files;  // by path

  bool empty() const noexcept { return files.empty(); }
  // "" when there is no such fact.
  std::string fact(const std::string& name) const;
};

// Of a text, as text.
std::string content_hash(std::string_view text);

// After open(), before the first message.
[[nodiscard]] bool write_inputs(McapWriter& file, const RunInputs& inputs);
// As far as the file has been read. Empty when the record has none. Throws InputError when they are damaged, or a path
// is not in normal form or leads out of the project: so no two of them mean one file.
RunInputs read_inputs(const McapReader& file, const std::string& path);

}  // namespace kadans
