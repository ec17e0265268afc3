// SPDX-License-Identifier: GPL-3.0-or-later

#include "Inlet.H"

namespace
{

//- Index of the mesh's patch of that name; a mesh without it ends the run
label patchOf(const fvMesh& mesh, const word& name)
{
    const label patch = mesh.boundaryMesh().findPatchID(name);
    if (patch < 0)
    {
        FatalErrorInFunction << "the mesh in " << mesh.time().path() / mesh.meshDir() << " has no patch "
                             << name << ", only " << flatOutput(mesh.boundaryMesh().names())
                             << ": give the bed's floor that name in system/blockMeshDict"
                             << " and run blockMesh again" << exit(FatalError);
    }
    return patch;
}

}

bedFoam::Inlet::Inlet(const fvMesh& mesh, const dictionary& gas)
    : mesh_(mesh),
      patch_(patchOf(mesh, "inlet")),
      area_(gSum(mesh.magSf().boundaryField()[patch_])),
      gasDensity_(gas.get<scalar>("density")),
      superficialVelocity_(Function1<scalar>::New("superficialVelocity", gas))
{}

scalar bedFoam::Inlet::superficialVelocity() const
{
    return superficialVelocity_->value(mesh_.time().value());
}

void bedFoam::Inlet::setVelocity(
    const volScalarField& voidage, volVectorField& U, surfaceScalarField& phi
) const
{
    // Between the particles the gas is faster by the voidage behind the inlet
    const scalarField behindInlet(voidage.boundaryField()[patch_]);
    U.boundaryFieldRef()[patch_] == vectorField(vector(0, 0, 1) * (superficialVelocity() / behindInlet));
    phi.boundaryFieldRef()[patch_] = mesh_.Sf().boundaryField()[patch_] & U.boundaryField()[patch_];
}

scalar bedFoam::Inlet::pressureDrop(const volScalarField& p) const
{
    return gasDensity_ / area_ * gSum(p.boundaryField()[patch_] * mesh_.magSf().boundaryField()[patch_]);
}
