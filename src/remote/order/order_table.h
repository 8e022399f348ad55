// The table of all orders that clients may give to a running instance. `kadans ctl` with its help and completion, the
// lines on its sockets, the web page and ROS 2 all use this table. A new order is one entry here and the code that
// carries it out.
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

#include "order.h"
#include "remote/ctl/ctl_folder.h"

namespace kadans {

struct OrderArgument {
  enum class Kind : std::uint8_t { none, text, number, flag, texts };
  const char* name = "";
  Kind kind = Kind::none;
  const char* shown = "";  // on the command line: "NAME", or an option, "--rate HZ"
  const char* doc = "";    // a sentence, when the order's own does not explain it
  const char* lists = "";  // one or two words of `list`, by which a shell completes it
  bool required = false;
  double min = std::numeric_limits<double>::lowest(), max = std::numeric_limits<double>::max();  // range of a number

  bool is_option() const noexcept { return shown[0] == '-'; }
};

struct OrderInfo {
  // Where an order may be given. ctl: on the command line and its sockets. all: there, on the page and by ROS 2. paced:
  // only on the page and by ROS 2, when the run's time can be held. sockets: only on the sockets, for consoles.
  enum class Faces : std::uint8_t { ctl, all, paced, sockets };

  const char* verb;
  const char* words;  // the words on the command line: "record start"
  Faces faces;
  Role role;
  const char* doc;
  std::optional<Order::Kind> kind;  // the order that it becomes; nullopt: the server answers by itself
  std::array<OrderArgument, 2> arguments{};

  bool is_brief() const noexcept { return faces == Faces::all || faces == Faces::paced; }
  // The first argument of this kind; nullptr: there is none.
  const OrderArgument* argument(OrderArgument::Kind kind) const noexcept;
};

std::span<const OrderInfo> order_table() noexcept;
const OrderInfo* find_order(std::string_view verb) noexcept;
// The verbs of the page and of ROS 2, separated by blanks.
std::string brief_verbs(bool paced);

}  // namespace kadans
