#include "run_inputs.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include <zstd.h>

#include "config/json/problems.h"
#include "kadans/signal/state_hash.h"
#include "signal/input_file.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

constexpr std::string_view prefix = "inputs/", suffix = ".zst";
constexpr std::size_t texts_max_bytes = std::size_t{64} << 20U;  // of all together, unpacked
constexpr std::size_t inputs_max = 10'000;
constexpr int text_compression_level = 6;  // also while a robot runs, when its record goes on in a new file

std::vector<std::byte> packed(const std::string& text) {
  Packer packer(text_compression_level);
  const std::span<const std::byte> bytes = packer.pack(bytes_of(text));
  return {bytes.begin(), bytes.end()};
}

std::string unpacked(const McapAttachment& attachment, std::size_t max_bytes, const std::string& record) {
  const unsigned long long size = ZSTD_getFrameContentSize(attachment.data.data(), attachment.data.size());
  if (size > max_bytes) refuse(record, "its input " + attachment.name + " is damaged or too large");
  std::string text(static_cast<std::size_t>(size), '\0');
  const std::size_t got = ZSTD_decompress(text.data(), text.size(), attachment.data.data(), attachment.data.size());
  if (ZSTD_isError(got) != 0 || got != text.size()) refuse(record, "its input " + attachment.name + " is damaged");
  return text;
}

// As kadans writes them: one name for one file. Whoever unpacks them may compare names, and none leads out.
bool right_path(const std::string& name) {
  const std::filesystem::path path(name);
  const bool climbs = std::ranges::any_of(path, [](const std::filesystem::path& part) { return part == ".."; });
  return !name.empty() && name.find('\0') == std::string::npos && !climbs && path.has_filename() &&
         path.lexically_normal().generic_string() == name && name != ".";
}

}  // namespace

void RunInputs::pack() {
  for (InputFile& file : files) {
    if (file.text) file.packed = kadans::packed(*file.text);
    file.text.reset();
  }
}

std::string content_hash(std::string_view text) {
  StateHash hash;
  for (const char c : text) hash.add(static_cast<unsigned char>(c));
  hash.add(text.size());
  return hash_text(hash.value());
}

bool write_inputs(McapWriter& file, const RunInputs& inputs) {
  TextMap hashes, left_out;
  bool written = file.add_metadata("run", inputs.run) && file.add_metadata("program", inputs.program);
  for (const InputFile& input : inputs.files) {
    hashes[input.path] = input.hash;
    if (input.left_out) left_out[input.path] = "yes";
    if (!input.text && input.packed.empty()) continue;
    const std::string name = std::string(prefix) + input.path + std::string(suffix);
    written = written && file.attach(name, "application/zstd", 0, input.text ? packed(*input.text) : input.packed);
  }
  if (!left_out.empty()) written = written && file.add_metadata("private", left_out);
  return written && file.add_metadata("inputs", hashes);
}

RunInputs read_inputs(const McapReader& file, const std::string& path) {
  RunInputs inputs;
  const auto known = [&](const char* name) {
    const auto found = file.metadata().find(name);
    return found == file.metadata().end() ? TextMap{} : found->second;
  };
  inputs.run = known("run");
  inputs.program = known("program");
  const TextMap left_out = known("private");
  std::size_t left_bytes = texts_max_bytes;
  for (auto& [name, hash] : known("inputs")) {
    if (inputs.files.size() == inputs_max) refuse(path, "it has more than " + std::to_string(inputs_max) + " inputs");
    if (!right_path(name)) refuse(path, "its input " + in_quotes(name) + " is no path inside a project");
    inputs.files.push_back({name, hash, std::nullopt, left_out.contains(name)});
  }
  for (const McapAttachment& attachment : file.attachments()) {
    const std::string& name = attachment.name;
    if (!name.starts_with(prefix) || !name.ends_with(suffix)) continue;
    const std::string of = name.substr(prefix.size(), name.size() - prefix.size() - suffix.size());
    const auto input = std::ranges::find(inputs.files, of, &InputFile::path);
    if (input == inputs.files.end() || input->text) continue;
    input->text = unpacked(attachment, left_bytes, path);
    left_bytes -= input->text->size();
    if (content_hash(*input->text) != input->hash) refuse(path, "its input " + of + " is damaged");
  }
  return inputs;
}

}  // namespace kadans
