#include "play_order_bytes.h"

namespace kadans {
namespace {

enum Type : std::uint8_t { number, boolean, text };

void put_argument(const PlayArgument& argument, ByteWriter& bytes) {
  bytes.put_string(argument.name);
  bytes.put(static_cast<std::uint8_t>(argument.value.index()));
  if (const auto* is_number = std::get_if<double>(&argument.value)) bytes.put(*is_number);
  if (const auto* is_true = std::get_if<bool>(&argument.value)) bytes.put<std::uint8_t>(*is_true);
  if (const auto* is_text = std::get_if<std::string>(&argument.value)) bytes.put_string(*is_text);
}

PlayArgument take_argument(ByteReader& bytes) {
  PlayArgument argument{.name = bytes.take_string(), .value = 0.0};
  switch (bytes.take<std::uint8_t>()) {
    case number:
      argument.value = bytes.take<double>();
      break;
    case boolean:
      argument.value = bytes.take<std::uint8_t>() != 0;
      break;
    default:
      argument.value = bytes.take_string();
  }
  return argument;
}

}  // namespace

void put_item(const PlayItem& item, ByteWriter& bytes) {
  bytes.put_string(item.file.string());
  bytes.put(item.lane);
  bytes.put_string(item.source);
  bytes.put(static_cast<std::uint32_t>(item.arguments.size()));
  for (const PlayArgument& argument : item.arguments) put_argument(argument, bytes);
}

PlayItem take_item(ByteReader& bytes) {
  PlayItem item{.file = bytes.take_string()};
  item.lane = bytes.take<std::uint32_t>();
  item.source = bytes.take_string();
  for (auto left = bytes.take<std::uint32_t>(); left > 0 && bytes.ok(); --left) {
    item.arguments.push_back(take_argument(bytes));
  }
  return item;
}

void put_order(const PlayOrder& order, ByteWriter& bytes) {
  bytes.put(static_cast<std::uint8_t>(order.kind));
  bytes.put_string(order.behavior.name);
  bytes.put_string(order.file.string());
  bytes.put(static_cast<std::uint32_t>(order.list.size()));
  for (const PlayItem& item : order.list) put_item(item, bytes);
}

PlayOrder take_order(ByteReader& bytes) {
  PlayOrder order{.kind = static_cast<PlayOrder::Kind>(bytes.take<std::uint8_t>())};
  order.behavior.name = bytes.take_string();
  order.file = bytes.take_string();
  for (auto left = bytes.take<std::uint32_t>(); left > 0 && bytes.ok(); --left) order.list.push_back(take_item(bytes));
  return order;
}

}  // namespace kadans
