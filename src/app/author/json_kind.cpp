#include "json_kind.h"

#include <optional>

#include "config/scenario/based_on.h"
#include "kadans/signal/input_error.h"
#include "signal/shell_word.h"

namespace kadans {
namespace {

struct Known {
  const char* name;     // "a robot's configuration"
  const char* command;  // the command that takes it, before the file's name ...
  const char* does;     // ... and what that command does
};

const Known& known(JsonKind kind) {
  static constexpr Known all[] = {{"something else", "check", "says what is wrong in it"},
                                  {"a scenario", "sim", "runs it"},
                                  {"a robot's configuration", "run", "drives it"},
                                  {"the plan of a sweep", "sweep", "runs it"},
                                  {"the plan of a tuning", "tune", "runs it"}};
  return all[static_cast<std::size_t>(kind)];
}

std::optional<JsonKind> kind_in(const std::filesystem::path& file) {
  try {
    return kind_of(parse_based_json(read_input_file(file), file.string()).value);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

}  // namespace

JsonKind kind_of(const JsonValue& json) {
  const auto has = [&](const char* key) { return json.find(key) != nullptr; };
  if (has("tune")) return JsonKind::tuning;
  if (has("scenarios")) return JsonKind::sweep;
  if (has("urdf") || has("control")) return JsonKind::robot;
  return has("robot") || has("duration_s") || has("checks") ? JsonKind::scenario : JsonKind::other;
}

void require_kind(const std::filesystem::path& file, JsonKind wanted) {
  const std::optional<JsonKind> kind = kind_in(file);
  if (!kind || *kind == wanted || *kind == JsonKind::other) return;
  const Known& is = known(*kind);
  throw InputError({.file = file.string(),
                    .message = std::string("is ") + is.name + ", not " + known(wanted).name + ": 'kadans " +
                               is.command + " " + shell_word(file.string()) + "' " + is.does});
}

}  // namespace kadans
