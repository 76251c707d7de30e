# slipfit on Debian 13.
#
#     docker build -t slipfit . && docker run --rm -v "$PWD:/data" slipfit fit /data/run.csv --speed 10mm/s
#
# The stage "development" has what the build and the tests need; .devcontainer opens the checkout in it.
FROM debian:trixie AS development
COPY scripts/install_dependencies.sh /tmp/install_dependencies.sh
RUN /tmp/install_dependencies.sh test browser && apt-get update -qq \
    && apt-get install -y -qq --no-install-recommends git clang-format clang-tidy && rm -rf /var/lib/apt/lists/*

FROM debian:trixie AS build
COPY . /slipfit
WORKDIR /slipfit
RUN scripts/install_dependencies.sh build && apt-get install -y -qq --no-install-recommends dpkg-dev file \
    && cmake --preset tool && cmake --build --preset tool \
    && cpack -G DEB --config build/tool/CPackConfig.cmake -B /packages

FROM debian:trixie-slim
RUN --mount=from=build,source=/packages,target=/packages apt-get update -qq \
    && apt-get install -y -qq --no-install-recommends /packages/slipfit_*.deb && rm -rf /var/lib/apt/lists/*
ENTRYPOINT ["slipfit"]
