# libvulkan-volk-dev ships volk as source; it is compiled once here.
find_path(STRANDLIGHT_VOLK_DIR volk.c REQUIRED)
add_library(strandlight3p_volk STATIC ${STRANDLIGHT_VOLK_DIR}/volk.c)
add_library(strandlight3p::volk ALIAS strandlight3p_volk)
target_include_directories(strandlight3p_volk SYSTEM PUBLIC ${STRANDLIGHT_VOLK_DIR} ${Vulkan_INCLUDE_DIRS})
target_compile_definitions(strandlight3p_volk PUBLIC VK_NO_PROTOTYPES)
target_link_libraries(strandlight3p_volk PUBLIC ${CMAKE_DL_LIBS})
