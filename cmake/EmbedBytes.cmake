# SPDX-License-Identifier: Apache-2.0
# cmake -DINPUT=file -DOUTPUT=header -DNAME=kConstant -P EmbedBytes.cmake: the bytes of a file as a
# constant of C++.
file(READ "${INPUT}" hex HEX)
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${hex}")
file(WRITE "${OUTPUT}" "#pragma once\n#include <cstdint>\ninline constexpr std::uint8_t ${NAME}[] = {${bytes}};\n")
