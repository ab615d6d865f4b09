# Eigen under the float contract (docs/explanation/conventions.md, decision determinism): what needs matrices links jaywalk_linear_algebra.
set(JAYWALK_EIGEN "" CACHE PATH "Eigen's headers, where they came along and are not installed")
add_library(jaywalk_linear_algebra INTERFACE)
if(JAYWALK_EIGEN)
  target_include_directories(jaywalk_linear_algebra SYSTEM INTERFACE ${JAYWALK_EIGEN})
else()
  find_package(Eigen3 3.3 REQUIRED NO_MODULE) # libeigen3-dev
  target_link_libraries(jaywalk_linear_algebra INTERFACE Eigen3::Eigen)
endif()
target_compile_definitions(jaywalk_linear_algebra INTERFACE
  EIGEN_DONT_VECTORIZE # its vector code calls fused instructions where the processor has them
  EIGEN_NO_MALLOC # a matrix that would allocate is an assert
  EIGEN_INITIALIZE_MATRICES_BY_ZERO) # nothing depends on memory never written
