#include "kadans/script/check_behavior.h"

#include "kadans/script/behavior.h"

namespace kadans {
namespace {

class Silence final : public BehaviorLog {
 public:
  void transition(const Transition& /*transition*/) override {}
  void message(std::int64_t /*time_ns*/, Severity /*severity*/, const std::string& /*behavior*/,
               const std::string& /*text*/) override {}
};

}  // namespace

std::vector<InputProblem> check_behavior(const std::filesystem::path& root, const std::filesystem::path& file,
                                         const Catalog& catalog) {
  Silence silence;
  try {
    const Behavior loaded({.root = root, .file = file.is_absolute() ? file : root / file}, catalog, silence);
  } catch (const InputError& error) {
    return error.problems();
  }
  return {};
}

}  // namespace kadans
