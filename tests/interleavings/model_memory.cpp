#include "model_memory.h"

#include <string_view>

namespace kadans::interleavings {
namespace {

rl::memory_order relacys(std::memory_order order) {
  switch (order) {
    case std::memory_order_relaxed:
      return rl::mo_relaxed;
    case std::memory_order_consume:
    case std::memory_order_acquire:
      return rl::mo_acquire;
    case std::memory_order_release:
      return rl::mo_release;
    case std::memory_order_acq_rel:
      return rl::mo_acq_rel;
    case std::memory_order_seq_cst:
      break;
  }
  return rl::mo_seq_cst;
}

}  // namespace

bool Site::operator==(const Site& other) const noexcept {
  return place.line == other.place.line && order == other.order && std::string_view(operation) == other.operation &&
         std::string_view(place.file == nullptr ? "" : place.file) ==
             std::string_view(other.place.file == nullptr ? "" : other.place.file);
}

rl::memory_order Orders::at(const Site& site) {
  std::size_t at = 0;
  while (at < count_ && !(sites_[at] == site)) ++at;
  if (at == count_ && count_ < sites_.size()) sites_[count_++] = site;
  return relacys(site == weakened_ ? to_ : site.order);
}

Orders& orders() noexcept {
  static Orders all;
  return all;
}

}  // namespace kadans::interleavings
