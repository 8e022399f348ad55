#include "kadans/campaign/shard.h"

#include <cstdlib>
#include <string_view>

#include "signal/input_file.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

std::optional<std::size_t> variable(const char* name) {
  const char* const text = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): before any thread is started
  if (text == nullptr || *text == '\0') return std::nullopt;
  const std::optional<std::size_t> value = number_of<std::size_t>(text);
  if (!value) refuse(name, "is '" + std::string(text) + "', must be a whole number");
  return value;
}

}  // namespace

Shard parse_shard(const std::string& text) {
  const std::size_t slash = text.find('/');
  const std::string_view all = text;
  const auto index = number_of<std::size_t>(all.substr(0, slash));
  const auto count = number_of<std::size_t>(slash == std::string::npos ? "" : all.substr(slash + 1));
  if (!index || !count || *count == 0) {
    refuse("--shard", "'" + text + "' must be PART/PARTS, such as 0/4");
  }
  const Shard shard{.index = *index, .count = *count};
  if (shard.index >= shard.count) {
    refuse("--shard", "'" + text + "': parts count from 0, the last of " + std::to_string(shard.count) + " is " +
                          std::to_string(shard.count - 1) + "/" + std::to_string(shard.count));
  }
  return shard;
}

std::optional<Shard> slurm_shard() {
  const auto id = variable("SLURM_ARRAY_TASK_ID");
  const auto count = variable("SLURM_ARRAY_TASK_COUNT");
  if (!id || !count) return std::nullopt;
  const std::size_t first = variable("SLURM_ARRAY_TASK_MIN").value_or(0);
  const std::size_t step = variable("SLURM_ARRAY_TASK_STEP").value_or(1);
  if (step == 0 || *id < first || (*id - first) % step != 0 || (*id - first) / step >= *count) {
    refuse("SLURM_ARRAY_TASK_ID", "is " + std::to_string(*id) + " in an array of " + std::to_string(*count) + " from " +
                                      std::to_string(first) + ": the array must be a range, such as --array=0-3");
  }
  return Shard{(*id - first) / step, *count};
}

}  // namespace kadans
