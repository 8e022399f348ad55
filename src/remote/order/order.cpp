#include "order.h"

#include <algorithm>

namespace kadans {

const OrderArgument* OrderInfo::argument(OrderArgument::Kind wanted) const noexcept {
  const auto found = std::ranges::find(arguments, wanted, &OrderArgument::kind);
  return found == arguments.end() ? nullptr : found;
}

const OrderInfo* find_order(std::string_view verb) noexcept {
  const auto found = std::ranges::find(order_table::orders, verb, &OrderInfo::verb);
  return found == std::end(order_table::orders) ? nullptr : found;
}

std::string brief_verbs(bool with_pace) {
  std::string verbs;
  for (const OrderInfo& order : order_table::orders) {
    if (order.is_brief() && (with_pace || order.faces != OrderInfo::Faces::paced))
      verbs += (verbs.empty() ? "" : " ") + std::string(order.verb);
  }
  return verbs;
}

}  // namespace kadans
