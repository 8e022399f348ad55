// JSON texts that are wrong, each with the message that it must give.
#pragma once

namespace kadans {

struct WrongJson {
  const char* text;
  const char* message;  // "line:column: what is wrong"
};

inline constexpr WrongJson wrong_json[] = {
    {"", "1:1: the file is empty, a JSON object is needed"},
    {"   // only a comment\n", "2:1: the file is empty, a JSON object is needed"},
    {"{", "1:2: the file ends inside an object, a closing } is missing"},
    {"[1, 2", "1:6: the file ends inside the array opened in line 1, a closing ] is missing"},
    {"{\"a\": 1", "1:8: the file ends inside the object opened in line 1, a closing } is missing"},
    {"{\"a\" 1}", "1:6: a colon is needed between key 'a' and its value, not '1'"},
    {"{\"a\": }", "1:7: a value is needed here, not '}'"},
    {"{a: 1}", "1:2: a key in double quotes is needed here, not 'a'"},
    {"{'a': 1}", "1:2: keys stand in double quotes"},
    {"{\"a\": 'b'}", "1:7: strings stand in double quotes"},
    {"{\"a\": 1,}", "1:8: a key must follow this comma, not '}'"},
    {"[1, 2,]", "1:6: a value must follow this comma, not ']'"},
    {"{\"a\": 1\n \"b\": 2}", "2:2: a comma or } is needed here, not a string"},
    {"[1 2]", "1:4: a comma or ] is needed here, not '2'"},
    {"{\"a\": 1, \"b\": 2,\n \"a\": 3}", "2:2: key 'a' stands twice in this object, first in line 1"},
    {"{} {}", "1:4: nothing may follow the end of the JSON text, but here stands '{'"},
    {"{\"a\": 1}}", "1:9: nothing may follow the end of the JSON text, but here stands '}'"},
    {"[01]", "1:2: a number must not begin with 0"},
    {"[1.]", "1:2: this number is not complete, a digit must follow '1.'"},
    {"[.5]", "1:2: a number begins with a digit or a minus sign"},
    {"[+1]", "1:2: a number begins with a digit or a minus sign"},
    {"[-]", "1:2: this number is not complete, a digit must follow '-'"},
    {"[1e]", "1:2: this number is not complete, a digit must follow '1e'"},
    {"[0x10]", "1:3: a number ends here, 'x10' must not follow it"},
    {"[1e999]", "1:2: the number '1e999' is beyond what a double can hold"},
    {"[-1e-999]", "1:2: the number '-1e-999' is beyond what a double can hold"},
    {"[NaN]", "1:2: 'NaN' is no JSON number, leave the key out"},
    {"[Infinity]", "1:2: 'Infinity' is no JSON number, leave the key out"},
    {"[-Infinity]", "1:2: infinity is no JSON number, leave the key out"},
    {"[True]", "1:2: 'True' is written in lower case in JSON"},
    {"[undefined]", "1:2: a value is needed here, not 'undefined'"},
    {"[\"abc]", "1:2: this string is not closed with \" in its line"},
    {"[\"a\nb\"]", "1:2: this string is not closed with \" in its line"},
    {"[\"a\tb\"]", "1:4: a control character in a string, write it as \\u00XX"},
    {"[\"\\x\"]", "1:3: unknown escape in a string, known are \\\" \\\\ \\/ \\b \\f \\n \\r \\t and \\uXXXX"},
    {"[\"\\u12G4\"]", "1:3: \\u needs four hexadecimal digits"},
    {"[\"\\ud800\"]", "1:3: half of a surrogate pair, no character"},
    {"[\"\\ud800\\u0041\"]", "1:3: half of a surrogate pair, no character"},
    {"/* open\n", "1:1: this comment is never closed with */"},
    {"/ {}", "1:1: a comment begins with // or /*"},
    {"{\"a\": 1;}", "1:8: a comma or } is needed here, not ';'"},
    {"{\"a\": \302\275}", "1:7: a value is needed here, not a character that is not JSON"},
    {"[\"ok\", \"\377\"]", "1:9: this byte is not UTF-8; save the file as UTF-8"},
    {"[\"\300\200\"]", "1:3: this byte is not UTF-8; save the file as UTF-8"},
    {"[\"\355\240\200\"]", "1:3: this byte is not UTF-8; save the file as UTF-8"},
    {"[1,\n\n  2,\n  oops]", "4:3: a value is needed here, not 'oops'"},
};

}  // namespace kadans
