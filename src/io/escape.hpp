// Text in XML and HTML.
#pragma once
#include <string>
#include <string_view>

namespace bagnold::io {

// `text` with the characters that XML and HTML give a meaning to (& < > ") written as entities.
std::string escaped(std::string_view text);

}  // namespace bagnold::io
