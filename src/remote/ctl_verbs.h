// The verbs of ctl's protocol: who may use them, what they take, which order they become.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "ctl_json.h"
#include "kadans/remote/ctl_folder.h"
#include "kadans/remote/order.h"

namespace kadans {

struct CtlField {
  enum class Kind : std::uint8_t { none, text, number, flag, texts };
  const char* name = "";
  Kind kind = Kind::none;
  bool required = false;
};

struct CtlVerb {
  const char* name;
  Role role;
  std::optional<Order::Kind> order;  // it becomes; nothing: it is answered at once
  std::array<CtlField, 2> fields{};
};

// A request that keeps the rules.
struct CtlRequest {
  const CtlVerb* verb = nullptr;
  Json json;

  std::string text(const char* field) const { return json.value(field, std::string()); }
  double number(const char* field, double without) const { return json.value(field, without); }
  bool flag(const char* field) const { return json.value(field, false); }
};

// Throws InputError: no JSON, unknown verb or field, one missing or of another kind, not for this role.
CtlRequest read_request(const std::string& line, Role role);

}  // namespace kadans
