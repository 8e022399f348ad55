// JSON of strangers: depth, bytes, and what is said of it.
#include "config/json/foreign_json.h"

#include <string>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "config/json/json_value.h"

namespace foreign_json_test {

using namespace kadans;

namespace {

std::string nested(std::size_t deep) { return std::string(deep, '[') + std::string(deep, ']'); }

std::string why_not(const std::string& text, const std::string& file = "") {
  try {
    (void)parse_foreign_json(text, file);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("JSON of strangers nests as deep as is allowed and no deeper, whatever its strings hold") {
  CHECK(read_foreign_json(nested(json_depth_max)).has_value());
  CHECK_FALSE(read_foreign_json(nested(json_depth_max + 1)).has_value());
  CHECK_FALSE(read_foreign_json(nested(200'000)).has_value());
  CHECK(read_foreign_json(R"({"a":")" + std::string(1000, '[') + R"(\"{{{"})").has_value());
  CHECK(read_foreign_json(R"(["[\\", "]"])").has_value());
}

TEST_CASE("JSON of strangers that is refused is named by its place, without a byte of it") {
  CHECK(why_not("{\"a\":\n \xFF}", "x.json") == "x.json:2:2: this is no JSON");
  CHECK(why_not("\xC3") == "this is no JSON (line 1, column 1)");
  CHECK(why_not("[1e999]").find("double") != std::string::npos);
  CHECK(why_not(nested(100)) == "values are nested deeper than 64 levels (line 1, column 65)");
  CHECK(why_not("{}").empty());
}

TEST_CASE("bytes of strangers that are no UTF-8 do not keep a tree from being written") {
  CHECK(json_text({{"said", "a\xFF"}}) == "{\"said\":\"a\xEF\xBF\xBD\"}");
}

TEST_CASE("JSON is written with no character in it that a terminal obeys, and is read back as it was") {
  const nlohmann::ordered_json said{{"text", "\xc2\x9b[2J \x7f \xe2\x80\xae \xc3\xa9 \033"}};
  const std::string text = json_text(said);
  CHECK(text == R"({"text":"\u009b[2J \u007f \u202e )"
                "\xc3\xa9 \\u001b\"}");
  CHECK(read_foreign_json(text) == said);
}

}  // namespace foreign_json_test
