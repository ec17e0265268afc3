// SPDX-License-Identifier: GPL-3.0-or-later

#include "fvCFD.H"

#include "Reconstruction.H"

bedFoam::Reconstruction::Reconstruction(const fvMesh& mesh)
    : normal_(mesh.Sf() / mesh.magSf()),
      fromFaces_(inv(fvc::surfaceSum(normal_ * mesh.Sf())))
{}

tmp<volVectorField> bedFoam::Reconstruction::operator()(const surfaceScalarField& flux) const
{
    return fromFaces_ & fvc::surfaceSum(normal_ * flux);
}
