// JSON of files and of clients: our reader agrees with nlohmann-json on what is JSON and what it says, and what a
// client says is said back as the same text.
#include "config/json/foreign_json.h"

#include <nlohmann/json.hpp>

#include "config/json/json_agreement.h"
#include "fuzz_input.h"

namespace {

using namespace kadans;
using fuzz::require;

void read_as_file(const std::string& text) {
  try {
    (void)parse_json(text, "t");
  } catch (const InputError& error) {
    fuzz::require_told(error, "t");
  }
  if (text.find('\0') != std::string::npos) return;  // nlohmann-json takes one in a comment for the end
  const std::string verdict = disagreement(text);
  require(verdict.empty(), verdict);
}

void read_as_foreign(const std::string& text) {
  const std::optional<nlohmann::ordered_json> read = read_foreign_json(text);
  try {
    const nlohmann::ordered_json json = parse_foreign_json(text, "t");
    require(read && *read == json, "both ways to read it agree");
    const std::string said = json_text(json);
    require(parse_foreign_json(said) == json && json_text(parse_foreign_json(said)) == said,
            "it is said back as it is");
  } catch (const InputError& error) {
    require(!read, "both ways to read it refuse it");
    const bool number = std::string_view(error.what()).find("beyond what a double") != std::string_view::npos;
    fuzz::require_told(error, "t", number ? fuzz::Placed::nowhere : fuzz::Placed::column);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  read_as_file(text);
  read_as_foreign(text);
  return 0;
}
