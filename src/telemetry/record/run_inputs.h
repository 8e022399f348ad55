// The inputs of a run. They are stored in its record so that the run can be repeated: its facts (scenario, seed,
// duration, settings of the command line), the program and its libraries, and the files that it read.
//
// In the record they are: metadata "run" and "program"; metadata "inputs" with the hash of every file by its path; each
// text file as a compressed attachment "inputs/PATH.zst", which any tool can extract. A file that is too large or no
// text (a plug-in, a mesh) is stored as its hash alone, and so is one that is private, which metadata "private" names.
// All inputs stand before the first message, so a record that is cut short still has them.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "signal/number_text.h"
#include "telemetry/mcap/mcap_reader.h"
#include "telemetry/mcap/mcap_writer.h"

namespace kadans {

struct InputFile {
  std::string path;  // from the project's root; "beside/x" from the scenario's folder; absolute elsewhere
  std::string hash;  // of its content, 16 hexadecimal digits
  std::optional<std::string> text;
  bool left_out = false;               // it is private: whoever runs the record again has to have it
  std::vector<std::byte> packed = {};  // the text, for a run that keeps it in memory until a record is written
};

struct RunInputs {
  TextMap run;
  TextMap program;
  std::vector<InputFile> files;  // by path

  bool empty() const noexcept { return files.empty(); }
  std::string fact(const std::string& name) const { return fact_in(run, name); }
  void pack();  // the texts
};

// The hash of a text, as text.
std::string content_hash(std::string_view text);

// Call it after open() and before the first message.
[[nodiscard]] bool write_inputs(McapWriter& file, const RunInputs& inputs);
// Reads the inputs from the part of the file that the reader has read; empty when the record has none. Throws
// InputError when they are damaged, or when a path is not in normal form or leads out of the project. So no two paths
// name the same file.
RunInputs read_inputs(const McapReader& file, const std::string& path);

}  // namespace kadans
