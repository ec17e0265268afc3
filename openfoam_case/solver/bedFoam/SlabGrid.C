// SPDX-License-Identifier: GPL-3.0-or-later

#include "SlabGrid.H"

#include <algorithm>
#include <cmath>

namespace
{

constexpr double largestDiffusion = 0.25;   // of one pass: below 1/2 the pass is stable, at 1/4 it has no negative mode

}

bedFoam::SlabGrid::SlabGrid
(
    const std::array<int, 3>& cells, const std::array<double, 3>& origin,
    const std::array<double, 3>& size, int rank, int ranks
)
:
    cells_(cells),
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
        missing[d] = cells_[d] > 1 ? std::max(0.0, length*length/12/(size_[d]*size_[d]) - 1.0/6) : 0;
        mostPasses = std::max(mostPasses, missing[d]/(2*largestDiffusion));
    }
    passes_ = static_cast<int>(std::ceil(mostPasses));
    for (int d = 0; d < 3; ++d) diffusion_[d] = passes_ ? missing[d]/(2*passes_) : 0;
}

bedFoam::SlabField bedFoam::SlabGrid::field(int components) const
{
    const size_t cells = static_cast<size_t>(cells_[0] + 2)*cells_[1]*cells_[2];
    return {components, std::vector<double>(cells*components, 0.0)};
}

bedFoam::Stencil bedFoam::SlabGrid::locate(const double* position) const
{
    Stencil stencil;
    for (int d = 0; d < 3; ++d)
    {
        const bool ghosts = d == 0;
        const int first = ghosts && lowerRank_ != MPI_PROC_NULL ? -1 : 0;
        const int last = ghosts && upperRank_ != MPI_PROC_NULL ? cells_[d] : cells_[d] - 1;
        const double offset = (position[d] - origin_[d])/size_[d] - 0.5;
        const int below = static_cast<int>(std::floor(offset));
        // Beyond the outermost centre both ends fall on that cell: nothing leaves through a wall
        stencil.lower[d] = std::min(std::max(below, first), last);
        stencil.upper[d] = std::min(std::max(below + 1, first), last);
        stencil.upperWeight[d] = offset - below;
    }
    return stencil;
}

void bedFoam::SlabGrid::deposit(SlabField& field, const Stencil& stencil, const double* value) const
{
    const int components = field.components;
    forCells(stencil, [&](int cell, double weight)
    {
        double* target = &field.values[static_cast<size_t>(cell)*components];
        for (int c = 0; c < components; ++c) target[c] += weight*value[c];
    });
}

void bedFoam::SlabGrid::sample(const SlabField& field, const Stencil& stencil, double* value) const
{
    const int components = field.components;
    std::fill(value, value + components, 0.0);
    forCells(stencil, [&](int cell, double weight)
    {
        const double* source = &field.values[static_cast<size_t>(cell)*components];
        for (int c = 0; c < components; ++c) value[c] += weight*source[c];
    });
}

void bedFoam::SlabGrid::completeDeposit(SlabField& field) const
{
    collectGhosts(field);
    smooth(field);
}

void bedFoam::SlabGrid::prepareSample(SlabField& field) const
{
    smooth(field);
    fillGhosts(field);
}

void bedFoam::SlabGrid::smooth(SlabField& field) const
{
    for (int pass = 0; pass < passes_; ++pass)
    {
        for (int direction = 0; direction < 3; ++direction)
        {
            if (diffusion_[direction] > 0) diffuse(field, direction);
        }
    }
}

void bedFoam::SlabGrid::diffuse(SlabField& field, int direction) const
{
    fillGhosts(field);
    const SlabField before = field;
    const int stride = direction == 0 ? 1 : direction == 1 ? cells_[0] + 2 : (cells_[0] + 2)*cells_[1];
    for (int k = 0; k < cells_[2]; ++k) for (int j = 0; j < cells_[1]; ++j) for (int i = 0; i < cells_[0]; ++i)
    {
        const int along = direction == 0 ? i : direction == 1 ? j : k;
        const int cell = index(i, j, k);
        // Ghosts in x hold a copy of the last cell at a wall; the other directions stop at their own ends
        const int below = direction > 0 && along == 0 ? cell : cell - stride;
        const int above = direction > 0 && along == cells_[direction] - 1 ? cell : cell + stride;
        for (int c = 0; c < field.components; ++c)
        {
            const auto value = [&](int at) { return before.values[static_cast<size_t>(at)*field.components + c]; };
            field.values[static_cast<size_t>(cell)*field.components + c] +=
                diffusion_[direction]*(value(below) - 2*value(cell) + value(above));
        }
    }
}

template<class Visit>
void bedFoam::SlabGrid::forLayer(SlabField& field, int i, const std::vector<double>& values, Visit visit) const
{
    size_t n = 0;
    for (int k = 0; k < cells_[2]; ++k) for (int j = 0; j < cells_[1]; ++j)
    {
        double* target = &field.values[static_cast<size_t>(index(i, j, k))*field.components];
        for (int c = 0; c < field.components; ++c) visit(target[c], values[n++]);
    }
}

std::vector<double> bedFoam::SlabGrid::layer(const SlabField& field, int i) const
{
    std::vector<double> values;
    values.reserve(static_cast<size_t>(cells_[1])*cells_[2]*field.components);
    for (int k = 0; k < cells_[2]; ++k) for (int j = 0; j < cells_[1]; ++j)
    {
        const double* source = &field.values[static_cast<size_t>(index(i, j, k))*field.components];
        values.insert(values.end(), source, source + field.components);
    }
    return values;
}

std::array<std::vector<double>, 2> bedFoam::SlabGrid::exchange
(
    const std::vector<double>& toLower, const std::vector<double>& toUpper
) const
{
    const int n = static_cast<int>(toLower.size());
    std::vector<double> fromLower(n, 0.0), fromUpper(n, 0.0);
    MPI_Sendrecv(toLower.data(), n, MPI_DOUBLE, lowerRank_, 1, fromUpper.data(), n, MPI_DOUBLE, upperRank_, 1,
        MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    MPI_Sendrecv(toUpper.data(), n, MPI_DOUBLE, upperRank_, 2, fromLower.data(), n, MPI_DOUBLE, lowerRank_, 2,
        MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    return {fromLower, fromUpper};
}

void bedFoam::SlabGrid::collectGhosts(SlabField& field) const
{
    const int last = cells_[0] - 1;
    const auto received = exchange(layer(field, -1), layer(field, last + 1));
    const auto add = [](double& target, double value) { target += value; };
    forLayer(field, 0, received[0], add);
    forLayer(field, last, received[1], add);
}

void bedFoam::SlabGrid::fillGhosts(SlabField& field) const
{
    const int last = cells_[0] - 1;
    const auto first = layer(field, 0), final = layer(field, last);
    const auto received = exchange(first, final);
    const auto set = [](double& target, double value) { target = value; };
    forLayer(field, -1, lowerRank_ == MPI_PROC_NULL ? first : received[0], set);
    forLayer(field, last + 1, upperRank_ == MPI_PROC_NULL ? final : received[1], set);
}

std::array<double, 3> bedFoam::SlabGrid::centre(int cell) const
{
    const int row = cell/cells_[0];
    const std::array<int, 3> at{cell % cells_[0], row % cells_[1], row/cells_[1]};
    std::array<double, 3> position;
    for (int d = 0; d < 3; ++d) position[d] = origin_[d] + (at[d] + 0.5)*size_[d];
    return position;
}
