function lumped_model(folder, mistake)
% The lumped model of planetary gear sets (Lin & Parker 1999), written from docs/results.md alone: builds M and K of
% five sets, computes frequencies, types and multiplicities of their modes, and writes all as a results folder.
% For MATLAB and for Octave:
%
%   octave-cli --path examples/results --eval "lumped_model('FOLDER')"
%   epicyclic validate --recorded FOLDER        (exit code 0)
%   lumped_model('FOLDER', 'ring_angle_sign')   (exit code 1: a wrong model is found)
  if nargin < 2
    mistake = 'none';
  end
  if ~any(strcmp(mistake, {'none', 'ring_angle_sign', 'inertia_not_over_r2', 'equal_spacing'}))
    error('mistake: none, ring_angle_sign, inertia_not_over_r2 or equal_spacing');
  end
  for path = {folder, fullfile(folder, 'matrices')}
    if ~exist(path{1}, 'dir')
      mkdir(path{1});
    end
  end
  write(fullfile(folder, 'results.toml'), { ...
    'format = 1', 'kind = "lumped"', 'program = "lumped_model.m"', 'version = "1.0"', '', ...
    '[convention]', 'order = ["carrier", "ring", "sun", "planets"]', 'planets = "radial_tangential"', ...
    'rotation = "arc"', 'radius = "base"', 'sense = "counter_clockwise"'});
  lines = {'scene,frequency_hz,mode_type,multiplicity'};
  for set = sets(mistake)
    [M, K, free] = matrices(set, mistake);
    dlmwrite(fullfile(folder, 'matrices', [set.scene, '.M.csv']), M, 'precision', '%.10g');
    dlmwrite(fullfile(folder, 'matrices', [set.scene, '.K.csv']), K, 'precision', '%.10g');
    lines = [lines, modes(M, K, free, set)];
  end
  write(fullfile(folder, 'modes.csv'), lines);
end

function write(path, lines)
  file = fopen(path, 'w');
  fprintf(file, '%s\n', lines{:});
  fclose(file);
end

% The sets. SI units; lists of bodies are carrier, ring, sun, planet; `inertia` is I/r^2, kg.
function list = sets(mistake)
  degree = pi / 180;
  model.scene = 'lin_parker_1999_3p';
  model.mass = [5.43, 2.35, 0.4, 0.66];
  model.inertia = [6.29, 3.00, 0.39, 0.61];
  model.bearing = [1e8, 1e8, 1e8, 1e8];
  model.torsion = [0, 1e9, 0];
  model.mesh = [5e8, 5e8];                % sun, ring
  model.angle = [24.6, 24.6] * degree;    % sun, ring
  model.held = [];                        % numbers of coordinates
  model.psi = equal(3);
  list = model;
  model.scene = 'lin_parker_1999_4p';
  model.psi = equal(4);
  list(end + 1) = model;

  polar = [49.7e-3, 0, 0.483e-3, 1.27e-3];   % I, kg m^2
  model.scene = 'oh58_3p_as_published';
  model.mass = [5.43, 0, 0.40, 0.66];
  model.inertia = over_r2(polar, [88.9e-3, 1, 35.2e-3, 45.63e-3], mistake);
  model.bearing = [87.6e6, 0, 87.6e6, 87.6e6];
  model.torsion = [0, 0, 0];
  model.mesh = [350e6, 350e6];
  model.held = [3, 4, 5, 6];              % rotation of the carrier, and the ring
  model.psi = equal(3);
  list(end + 1) = model;
  model.scene = 'oh58_4p_as_published';
  model.psi = equal(4);
  list(end + 1) = model;

  % Base radii go with numbers of teeth, 27, 35 and 99; operating pressure angles follow from them.
  distance = 88.9e-3;
  planet = 91.26e-3 / 2;
  sun = planet * 27 / 35;
  ring = planet * 99 / 35;
  model.scene = 'oh58_4p';
  model.inertia = over_r2(polar, [distance, 1, sun, planet], mistake);
  model.angle = acos([sun + planet, ring - planet] / distance);
  if ~strcmp(mistake, 'equal_spacing')
    model.psi = 2 * pi / (27 + 99) * [0, -31, 63, 32];
  end
  list(end + 1) = model;
end

function psi = equal(count)
  psi = 2 * pi * (0:count - 1) / count;
end

function inertia = over_r2(polar, radius, mistake)
  inertia = polar ./ radius .^ 2;
  if strcmp(mistake, 'inertia_not_over_r2')
    inertia = polar;
  end
end

% M and K on the coordinates that are not held, and the numbers of those: three of each body in the order carrier,
% ring, sun, planets.
function [M, K, free] = matrices(set, mistake)
  N = numel(set.psi);
  size = 3 * (3 + N);
  body = [1:3, 4 * ones(1, N)];
  M = zeros(size);
  K = zeros(size);
  for j = 1:3 + N
    M(3 * j - 2:3 * j, 3 * j - 2:3 * j) = diag([set.mass(body(j)) * [1, 1], set.inertia(body(j))]);
  end
  for j = 1:3
    K(3 * j - 2:3 * j, 3 * j - 2:3 * j) = diag([set.bearing(j) * [1, 1], set.torsion(j)]);
  end
  carrier = 1:3;
  ring = 4:6;
  sun = 7:9;
  as = set.angle(1);
  ar = set.angle(2);
  if strcmp(mistake, 'ring_angle_sign')
    ar = -ar;
  end
  for n = 1:N
    psi = set.psi(n);
    planet = 3 * (3 + n) + (-2:0);
    b = zeros(size, 1);
    b(sun) = [-sin(psi - as), cos(psi - as), 1];
    b(planet) = [-sin(as), -cos(as), 1];
    K = K + set.mesh(1) * (b * b');
    b = zeros(size, 1);
    b(ring) = [-sin(psi + ar), cos(psi + ar), 1];
    b(planet) = [sin(ar), -cos(ar), -1];
    K = K + set.mesh(2) * (b * b');
    b = zeros(size, 2);
    b(carrier, :) = [cos(psi), -sin(psi); sin(psi), cos(psi); 0, 1];
    b(planet, :) = [-1, 0; 0, -1; 0, 0];
    K = K + set.bearing(4) * (b * b');
  end
  free = setdiff(1:size, set.held);
  M = M(free, free);
  K = K(free, free);
end

% Orthonormal bases of the rotational and the translational subspace. Planets are equal, so that coordinates scaled by
% the root of the mass have the same patterns.
function [rotational, translational] = kinds(free, psi)
  N = numel(psi);
  size = 3 * (3 + N);
  E = eye(size);
  rotational = E(:, [3, 6, 9]);
  translational = E(:, [1, 2, 4, 5, 7, 8]);
  for axis = 1:3
    place = 9 + axis + 3 * (0:N - 1);
    pattern = zeros(size, 3);
    pattern(place, :) = [ones(N, 1), cos(psi'), sin(psi')];
    rotational = [rotational, pattern(:, 1)];
    translational = [translational, pattern(:, 2:3)];
  end
  rotational = orth(rotational(free, :));
  translational = orth(translational(free, :));
end

% A line of the table for every frequency and type of mode, ascending.
function lines = modes(M, K, free, set)
  root = sqrt(diag(M));
  A = K ./ (root * root');
  [vectors, squares] = eig((A + A') / 2);   % of M^(1/2) q
  [squares, order] = sort(diag(squares));
  vectors = vectors(:, order);
  near = 1e-9 * squares(end);
  squares(abs(squares) < near) = 0;         % rigid-body motion
  [rotational, translational] = kinds(free, set.psi);
  first = [1; find(diff(squares) > near) + 1; numel(squares) + 1];
  names = {'rotational', 'translational', 'planet', 'mixed'};
  lines = {};
  for g = 1:numel(first) - 1
    group = first(g):first(g + 1) - 1;
    % How many dimensions of the group lie in each subspace; neither is a planet mode.
    of_rotation = sum(sum((rotational' * vectors(:, group)) .^ 2));
    of_translation = sum(sum((translational' * vectors(:, group)) .^ 2));
    counts = [of_rotation, of_translation, numel(group) - of_rotation - of_translation, 0];
    if any(abs(counts - round(counts)) > 1e-6)
      counts = [0, 0, 0, numel(group)];
    end
    frequency = sqrt(mean(squares(group))) / (2 * pi);
    for kind = find(round(counts) > 0)
      lines{end + 1} = sprintf('%s,%.10g,%s,%d', set.scene, frequency, names{kind}, round(counts(kind)));
    end
  end
end
