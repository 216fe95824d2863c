# An overlay port, for the sources of the repository that it lies in: vcpkg install libahm --overlay-ports=<repository>/packaging
set(SOURCE_PATH "${CURRENT_PORT_DIR}/../..")
vcpkg_check_features(OUT_FEATURE_OPTIONS options FEATURES program AHM_BUILD_APPS)
vcpkg_cmake_configure(SOURCE_PATH "${SOURCE_PATH}" OPTIONS ${options}
  -DAHM_WITH_FLANN=OFF -DAHM_WITH_MINIZIP=OFF -DAHM_WITH_PCL=OFF -DAHM_WITH_THREE=OFF
  -DAHM_BUILD_PYTHON=OFF -DAHM_BUILD_TESTS=OFF -DAHM_BUILD_EXAMPLES=OFF)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(PACKAGE_NAME ahm CONFIG_PATH lib/cmake/ahm)
vcpkg_copy_pdbs()
if("program" IN_LIST FEATURES)
  vcpkg_copy_tools(TOOL_NAMES ahm AUTO_CLEAN)
endif()
file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/debug/include" "${CURRENT_PACKAGES_DIR}/debug/share")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE")
