#include "kadans/signal/utf8.h"

#include <doctest/doctest.h>

using namespace kadans;

TEST_CASE("valid_utf8 leaves characters of every length and replaces each byte that is none") {
  const std::string good = "a\xc3\xa9\xe2\x82\xac\xf0\x9f\xa4\x96";
  CHECK(valid_utf8(good) == good);
  CHECK(find_invalid_utf8(good) == std::string::npos);
  const std::string bad = "\xef\xbf\xbd";
  for (const char* one : {"\xff", "\x80", "\xc0", "\xc3", "\xf5"}) CHECK(valid_utf8(one) == bad);
  CHECK(valid_utf8("\xe2\x82") == bad + bad);             // cut short
  CHECK(valid_utf8("\xc0\xaf") == bad + bad);             // longer than it needs to be
  CHECK(valid_utf8("\xed\xa0\x80") == bad + bad + bad);   // half of a pair
  CHECK(valid_utf8("\xf4\x90\x80\x80").size() == 4 * 3);  // beyond the last
  CHECK(find_invalid_utf8("ab\xff") == 2);
  CHECK(valid_utf8("").empty());
}

TEST_CASE("xml_characters leaves out what no writing makes a character of XML") {
  CHECK(xml_characters("a\tb\nc\r\x01\x1f\x7f") == "a\tb\nc\r\x7f");
  CHECK(xml_characters("\xef\xbf\xbe|\xef\xbf\xbf|\xef\xbf\xbd") == "||\xef\xbf\xbd");
  CHECK(xml_characters("\xff") == "\xef\xbf\xbd");
}
