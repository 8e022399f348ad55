// Values are changed in a JSON text, and all that is not changed stays as it was written.
#include "config/json/json_edit.h"

#include <doctest/doctest.h>

#include "kadans/signal/input_error.h"

namespace json_edit_test {

using namespace kadans;

TEST_CASE("An edited value leaves comments, order and blanks as they are, and a new one comes last in its object") {
  const std::string text = R"({
  "b": { "x": 1, "y": 2 }, // said
  "a": {
    "deep": { }
  }
})";
  CHECK(edit_json(text, "f", {{{"b", "x"}, "3"}, {{"a", "deep", "z"}, "true"}, {{"a", "k", "l"}, "\"w\""}}) == R"({
  "b": { "x": 3, "y": 2 }, // said
  "a": {
    "deep": { "z": true  },
    "k": { "l": "w" }
  }
})");
  CHECK_THROWS_AS(edit_json(text, "f", {{{"b", "x", "y"}, "3"}}), InputError);
  CHECK_THROWS_AS(edit_json(text, "f", {{{"b"}, "3"}}), InputError);
}

TEST_CASE("An item of a list is found by its name, and one that is not there is added with its name") {
  const std::string text = R"({ "list": [ { "name": "one", "p": { "k": 1 } }, { "name": "two" } /* last */ ] })";
  const std::string edited =
      edit_json(text, "f", {{{"list", "[one]", "p", "k"}, "5"}, {{"list", "[two]", "p", "k"}, "6"}});
  CHECK(edited ==
        R"({ "list": [ { "name": "one", "p": { "k": 5 } }, { "name": "two", "p": { "k": 6 } } /* last */ ] })");
  CHECK(find_at(parse_json(edited, "f"), {"list", "[two]", "p", "k"})->number == 6);
  CHECK(find_at(parse_json(edited, "f"), {"list", "[three]", "p", "k"}) == nullptr);
  CHECK(edit_json(R"({ "list": [] })", "f", {{{"list", "[one]", "k"}, "1"}}) ==
        R"({ "list": [{ "name": "one", "k": 1 }] })");
  CHECK(edit_json(R"({ "list": [{ "name": "one" }] })", "f", {{{"list", "[two]", "k"}, "1"}}) ==
        R"({ "list": [{ "name": "one" }, { "name": "two", "k": 1 }] })");
  CHECK(edit_json("{ }", "f", {{{"a", "[one]", "k"}, "1"}}) == R"({ "a": [{ "name": "one", "k": 1 }]  })");
  CHECK_THROWS_AS(edit_json(R"({ "list": {} })", "f", {{{"list", "[one]", "k"}, "1"}}), InputError);
  CHECK_THROWS_AS(edit_json(R"({ "list": [] })", "f", {{{"list", "one", "k"}, "1"}}), InputError);
}

}  // namespace json_edit_test
