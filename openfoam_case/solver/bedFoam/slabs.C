// SPDX-License-Identifier: GPL-3.0-or-later

#include "slabs.H"

namespace
{

//- Whether the mesh numbers its cells as the grid does, each in the same place to the tolerance [m]
bool sameCells(const fvMesh& mesh, const bedFoam::SlabGrid& grid, double tolerance)
{
    if (mesh.nCells() != grid.size()) return false;
    forAll(mesh.C(), cell)
    {
        const auto centre = grid.centre(cell);
        if (mag(mesh.C()[cell] - vector(centre[0], centre[1], centre[2])) > tolerance) return false;
    }
    return true;
}

}

bedFoam::SlabGrid bedFoam::ownSlab(const dictionary& parameters)
{
    const int rank = Pstream::myProcNo();
    const int ranks = Pstream::nProcs();
    const std::array<int, 3> cells{
        static_cast<int>(parameters.get<label>("gas_cells_x")),
        static_cast<int>(parameters.get<label>("gas_cells_y")),
        static_cast<int>(parameters.get<label>("gas_cells_z"))
    };
    if (cells[0] % ranks)
    {
        FatalErrorInFunction << cells[0] << " gas cells along x cannot be cut into " << ranks
                             << " equal slabs: choose gas.cell_size_m or run.ranks so that they can"
                             << exit(FatalError);
    }
    const double low = parameters.get<scalar>("slab_low");
    const std::array<double, 3> size{
        parameters.get<scalar>("width") / cells[0], (parameters.get<scalar>("slab_high") - low) / cells[1],
        parameters.get<scalar>("height") / cells[2]
    };
    const int own = cells[0] / ranks;
    SlabGrid grid({own, cells[1], cells[2]}, {rank * own * size[0], low, 0}, size, rank, ranks);
    grid.setSmoothingLength(
        parameters.get<scalar>("smoothing_diameters") * parameters.get<scalar>("particle_diameter")
    );
    return grid;
}

void bedFoam::checkSlabs(const fvMesh& mesh, const SlabGrid& grid, const Liggghts& dem, double tolerance)
{
    const boundBox box(mesh.points(), false);
    const bool sameSlab = mag(box.min().x() - dem.slab().first) < tolerance
        && mag(box.max().x() - dem.slab().second) < tolerance;
    if (!returnReduce(sameCells(mesh, grid, tolerance) && sameSlab, andOp<bool>()))
    {
        FatalErrorInFunction
            << "gas mesh and particle domain are not cut into the same slabs: the mesh must be the block of"
            << " system/blockMeshDict, cut by system/decomposeParDict" << exit(FatalError);
    }
}
