// Trees are written as the project's files are laid out.
#include "config/json/json_layout.h"

#include <doctest/doctest.h>

#include "config/json/json_value.h"

namespace json_layout_test {

using namespace kadans;

TEST_CASE("A file in our layout is written as it stands: short values on a line, a line for each object of a list") {
  const std::string text = R"({
  "name": "nudge",
  "duration_s": 4.50,
  "tags": ["push"],
  "set": { "ground.friction": 1e-3 },
  "pushes": [
    { "link": "torso", "at_s": 1, "impulse_Ns": [0, -1.5, 0] }
  ],
  "sure": true,
  "nothing": null,
  "empty": {},
  "none": []
}
)";
  CHECK(laid_out(parse_json(text, "f")) == text);
}

TEST_CASE("What is too long for a line has one for each member, and strings are escaped") {
  JsonValue root;
  root.kind = JsonValue::Kind::object;
  JsonValue& set = member_of(root, "set");
  set.kind = JsonValue::Kind::object;
  for (int i = 0; i < 9; ++i) member_of(set, "a.long.name.of.a.quantity_" + std::to_string(i)) = json_number(0.25);
  member_of(root, "doc") = json_string("a \"word\"\n\\ ä");
  const std::string text = laid_out(root);
  CHECK(text.find("  \"set\": {\n    \"a.long.name.of.a.quantity_0\": 0.25,\n") != std::string::npos);
  CHECK(text.find(R"("doc": "a \"word\"\n\\ ä")") != std::string::npos);
  const JsonValue read = parse_json(text, "f");
  CHECK(read.find("doc")->value.text == "a \"word\"\n\\ ä");
  CHECK(read.find("set")->value.members.size() == 9);
  JsonValue less = read;
  erase_member(less, "set");
  member_of(less, "doc") = json_list({json_number(1), json_number(-0.5)});
  CHECK(laid_out(less) == "{\n  \"doc\": [1, -0.5]\n}\n");
}

}  // namespace json_layout_test
