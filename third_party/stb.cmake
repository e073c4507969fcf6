# libstb-dev has headers in <stb/...>; the implementations are compiled in engine/base/image_io.cpp.
find_path(STRANDLIGHT_STB_DIR stb/stb_image.h REQUIRED)
add_library(strandlight3p_stb INTERFACE)
add_library(strandlight3p::stb ALIAS strandlight3p_stb)
target_include_directories(strandlight3p_stb SYSTEM INTERFACE ${STRANDLIGHT_STB_DIR})
