#include "real_time_start.h"

#include <array>
#include <span>
#include <string_view>

#include "kadans/realtime/memory_lock.h"
#include "kadans/realtime/rights.h"
#include "terminal.h"

namespace kadans {
namespace {

constexpr std::size_t heap_reserve_bytes = std::size_t{2} << 20U;

// What reads files and terminals before the loop, or in other commands; then the model.
constexpr std::array<std::string_view, 12> unused{
    "libsqlite3.",   "libedit.",   "libtinfo.",          "libbsd.",           "libmd.",
    "liburdfdom_",   "libtinyxml", "libconsole_bridge.", "libBulletDynamics", "libBulletCollision",
    "libLinearMath", "libzstd."};
constexpr std::size_t unused_with_model = 8;

}  // namespace

bool rights_suffice(int priority, bool soft) {
  const std::vector<std::string> missing = missing_rights(read_rights("/"), priority);
  for (const std::string& right : missing) print_error((soft ? "going on without " : "missing ") + right);
  if (!missing.empty() && !soft) print_error("--soft goes on without, late as the system likes");
  return missing.empty() || soft;
}

void lock_program(bool with_model) noexcept {
  const std::span<const std::string_view> all(unused);
  (void)lock_memory(heap_reserve_bytes, with_model ? all.first(unused_with_model) : all);
}

}  // namespace kadans
