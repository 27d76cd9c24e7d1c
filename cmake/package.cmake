# cmake --install, and `cpack` for a Debian package whose dependencies are read off the binary.
include(GNUInstallDirs)
install(TARGETS bagnold RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(DIRECTORY cases DESTINATION ${CMAKE_INSTALL_DATADIR}/bagnold)
install(FILES README.md CHANGELOG.md LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})

set(CPACK_GENERATOR DEB)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)   # bagnold_0.1.0_amd64.deb
set(CPACK_PACKAGE_NAME bagnold)
set(CPACK_PACKAGE_CONTACT "The bagnold developers <bagnold@users.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS gnuplot-nox)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
include(CPack)
