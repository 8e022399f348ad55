// Everything that somebody outside may ask of a running instance: one table. `kadans ctl` with its help and completion,
// the lines of its sockets, the page and ROS 2 are faces of it; a new order is one entry here, and whoever carries it
// out.
//
// Any thread.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "kadans/remote/ctl_folder.h"
#include "kadans/remote/order.h"

namespace kadans {

struct OrderArgument {
  enum class Kind : std::uint8_t { none, text, number, flag, texts };
  const char* name = "";
  Kind kind = Kind::none;
  const char* shown = "";  // on the command line: "NAME", or an option, "--rate HZ"
  const char* doc = "";    // a sentence, where the order's own does not say it
  const char* lists = "";  // what a shell completes it by: words of `list`, one or two
  bool required = false;
  double min = std::numeric_limits<double>::lowest(), max = std::numeric_limits<double>::max();  // of a number

  bool is_option() const noexcept { return shown[0] == '-'; }
};

struct OrderInfo {
  // Where it may be given: on the command line and on its sockets; there as well, by the page and by ROS 2; by those
  // two alone, where time can be held; on the sockets, for consoles.
  enum class Faces : std::uint8_t { ctl, all, paced, sockets };

  const char* verb;
  const char* words;  // on the command line: "record start"
  Faces faces;
  Role role;
  const char* doc;
  std::optional<Order::Kind> kind;  // the order that it becomes; none: whoever serves the client answers by itself
  std::array<OrderArgument, 2> arguments{};

  bool is_brief() const noexcept { return faces == Faces::all || faces == Faces::paced; }
  // Its first argument of this kind; nullptr: it has none.
  const OrderArgument* argument(OrderArgument::Kind kind) const noexcept;
};

std::span<const OrderInfo> order_table() noexcept;
const OrderInfo* find_order(std::string_view verb) noexcept;
// Verbs of the page and ROS 2, with blanks between them.
std::string brief_verbs(bool paced);

}  // namespace kadans
