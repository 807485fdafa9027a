# cmake -DINPUT=x.spv -DOUTPUT=x.spv.h -DNAME=x_spv -P embed.cmake: SPIR-V words as a C++ array.
file(READ ${INPUT} bytes HEX)
string(REGEX REPLACE "(..)(..)(..)(..)" "0x\\4\\3\\2\\1," words "${bytes}")
file(WRITE ${OUTPUT} "#pragma once\n#include <cstdint>\ninline constexpr std::uint32_t ${NAME}[] = {${words}};\n")
