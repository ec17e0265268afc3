// SPDX-License-Identifier: GPL-3.0-or-later

#include "SlabGrid.H"

#include <algorithm>
#include <cmath>

namespace
{

// Of one pass: below 1/2 the pass is stable, at 1/4 it has no negative mode
constexpr double largestDiffusion = 0.25;

}

bedFoam::SlabGrid::SlabGrid(
    const std::array<int, 3>& cells, const std::array<double, 3>& origin, const std::array<double, 3>& size,
    int rank, int ranks
)
    : cells_(cells),
      origin_(origin),
      size_(size),
      lowerRank_(rank > 0 ? rank - 1 : MPI_PROC_NULL),
      upperRank_(rank < ranks - 1 ? rank + 1 : MPI_PROC_NULL)
{}

void bedFoam::SlabGrid::setSmoothingLength(double length)
{
    // Variances: top hat of width L, L^2/12; hat function of half-width h, h^2/6; one pass, 2 w h^2
    std::array<double, 3> missing;
    double mostPasses = 0;
    for (int d = 0; d < 3; ++d)
    {
        missing[d] =
            cells_[d] > 1 ? std::max(0.0, length * length / 12 / (size_[d] * size_[d]) - 1.0 / 6) : 0;
        mostPasses = std::max(mostPasses, missing[d] / (2 * largestDiffusion));
    }
    passes_ = static_cast<int>(std::ceil(mostPasses));
    for (int d = 0; d < 3; ++d) diffusion_[d] = passes_ ? missing[d] / (2 * passes_) : 0;
}

bedFoam::Stencil bedFoam::SlabGrid::locate(const double* position) const
{
    int lower[3], upper[3];
    double share[3];
    for (int d = 0; d < 3; ++d)
    {
        const bool ghosts = d == 0;
        const int first = ghosts && lowerRank_ != MPI_PROC_NULL ? -1 : 0;
        const int last = ghosts && upperRank_ != MPI_PROC_NULL ? cells_[d] : cells_[d] - 1;
        const double offset = (position[d] - origin_[d]) / size_[d] - 0.5;
        const int below = static_cast<int>(std::floor(offset));
        // Beyond the outermost centre both ends fall on that cell: nothing leaves through a wall
        lower[d] = std::min(std::max(below, first), last);
        upper[d] = std::min(std::max(below + 1, first), last);
        share[d] = offset - below;
    }

    Stencil stencil;
    stencil.count = 0;
    const int layers = cells_[1] == 1 ? 1 : 2;
    for (int z = 0; z < 2; ++z)
        for (int y = 0; y < layers; ++y)
            for (int x = 0; x < 2; ++x)
            {
                const double inY = layers == 1 ? 1 : y ? share[1] : 1 - share[1];
                stencil.cell[stencil.count] =
                    index(x ? upper[0] : lower[0], y ? upper[1] : lower[1], z ? upper[2] : lower[2]);
                stencil.weight[stencil.count] =
                    (x ? share[0] : 1 - share[0]) * inY * (z ? share[2] : 1 - share[2]);
                ++stencil.count;
            }
    return stencil;
}

void bedFoam::SlabGrid::swapLayers(double* lower, double* upper, int count) const
{
    // To a wall nothing is sent, and from there nothing comes: the layer stays as it was
    const std::vector<double> down(lower, lower + count), up(upper, upper + count);
    MPI_Sendrecv(
        down.data(), count, MPI_DOUBLE, lowerRank_, 1, upper, count, MPI_DOUBLE, upperRank_, 1,
        MPI_COMM_WORLD, MPI_STATUS_IGNORE
    );
    MPI_Sendrecv(
        up.data(), count, MPI_DOUBLE, upperRank_, 2, lower, count, MPI_DOUBLE, lowerRank_, 2, MPI_COMM_WORLD,
        MPI_STATUS_IGNORE
    );
}

std::array<double, 3> bedFoam::SlabGrid::centre(int cell) const
{
    const int row = cell / cells_[0];
    const std::array<int, 3> at{cell % cells_[0], row % cells_[1], row / cells_[1]};
    std::array<double, 3> position;
    for (int d = 0; d < 3; ++d) position[d] = origin_[d] + (at[d] + 0.5) * size_[d];
    return position;
}
