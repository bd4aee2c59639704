% The cases in GNU Octave: octave --norc --quiet octave_pairs.m CASES.json RESULTS.json RULE
%
% Every time step is a handful of operations on whole arrays of pairs, shape [N, K]; what is beyond the horizon has
% weight zero. RULE integrates the nonlocal source: "gauss", a fixed rule, or adaptively "integral", for all particles
% at once, or "quadgk", for each particle by itself.
1;

function s = scene_of(name)
  s.period = 2*pi;
  s.T = 1;
  s.u = @(x, t) cos(x - t);
  s.u_x = @(x, t) -sin(x - t);
  s.u_t = @(x, t) sin(x - t);
  switch name
    case "lee-du-2019"
      s.standing = false;
      s.c = @(x) cos(2*x)/3;
      s.c_prime = @(x) -2*sin(2*x)/3;
      s.b = @sin;
      s.b_prime = @cos;
      s.flow = @(x0, t) 2*atan2(sin(x0/2)*exp(t), cos(x0/2));
    case "standing"
      s.standing = true;
      s.c = @(x) 1/2 + sin(x);
      s.c_prime = @cos;
  end
end

function k = kernel_of(name)
  switch name
    case "inverse"
      k.eta = @(z) 1./z;
      k.first_moment = @(z) z;
      k.pieces = [0, 1];
    case "cubic-spline"
      k.eta = @(z) (z <= 0.5).*z.*(32 - 48*z) + (z > 0.5).*16.*(1 - z).^2;
      k.mass = @(z) (z <= 0.5).*z.^2.*(16 - 16*z) + (z > 0.5).*(8 - 16*(1 - z).^3)/3;
      k.first_moment = @(z) (z <= 0.5).*z.^3.*(32/3 - 12*z) + (z > 0.5).*(1 - (1 - z).^3.*(16/3 - 4*(1 - z)));
      k.pieces = [0, 0.5, 1];
  end
end

% ---------------------------------------------------------------------------------------------------------- neighbors

% Numbers of the particles j - s k, k = 1 .. K, and their distances d_k; s is 1, -1 or a column.
function [i, d] = neighbors(x, K, s, period)
  N = numel(x);
  j = (0:N-1)' - s.*(1:K);
  i = mod(j, N) + 1;
  d = s.*(x - (x(i) + period*floor(j/N)));
end

% The largest number of neighbors within the horizon on one side; 1 at least.
function K = widest_window(x, delta, period)
  within = delta*(1 + 1e-11);
  ahead = [x; x(x <= x(1) + within) + period];
  K = max(1, max(lookup(ahead, x + within) - (1:numel(x))'));
end

% Integrals over the cells that end at the distances d_k, the last one reaching to the horizon; shape of d.
function W = cells(antiderivative, d, delta)
  last = max(sum(d <= delta*(1 + 1e-11), 2), 1);
  k = 1:columns(d);
  outer = antiderivative(min(d/delta, 1));
  outer(k >= last) = antiderivative(1);
  W = diff([zeros(rows(d), 1), outer], 1, 2);
end

% -------------------------------------------------------------------------------------------------------------- rates

% (2.9) or (2.11), without the source.
function rate = model1_rate(g, s, kernel, x, u)
  c = s.c(x);
  b = s.b(x);
  c_hat = c - b;
  side = 2*(c_hat > 0) - 1;
  [i, d] = neighbors(x, widest_window(x, g.delta, s.period), side, s.period);
  W = cells(kernel.first_moment, d, g.delta)./d;
  flux = c_hat.*u;
  if strcmp(g.divergence, "local")
    rate = -s.b_prime(x).*u - side.*sum((flux - flux(i)).*W, 2);
  else
    rate = -side.*sum(((c - b(i)).*u - flux(i)).*W, 2);
  end
end

% (3.8) or (3.10), without the source.
function rate = model2_rate(g, s, kernel, x, u)
  K = widest_window(x, g.delta, s.period);
  moment = A = D = B = 0;
  reach = g.delta;
  for side = [1, -1]
    [i, d] = neighbors(x, K, side, s.period);
    W = cells(kernel.mass, d, g.delta);
    midpoint = x - side*d/2;
    b = s.b(midpoint);
    moment += sum(d.*W, 2);
    A -= side*sum((s.c(midpoint) - b).*(u + u(i)).*W, 2);
    D += sum((u(i) - u)./d.*W, 2);
    B -= side*sum(2*b.*W, 2);
    reach = max(reach, d(:, 1));
  end
  if strcmp(g.divergence, "local")
    rate = g.mu*reach.*D./moment - A./moment - s.b_prime(x).*u;
  else
    rate = g.mu*reach.*D./moment - A./moment - B./moment.*u;
  end
end

% (2.4) as a sparse matrix, without the source.
function R = standing_rate(g, s, kernel, x)
  c = s.c(x);
  side = 2*(c > 0) - 1;
  [i, d] = neighbors(x, widest_window(x, g.delta, s.period), side, s.period);
  W = side.*cells(kernel.first_moment, d, g.delta)./d;
  N = numel(x);
  j = repmat((1:N)', 1, columns(d));
  R = sparse([(1:N)'; j(:)], [(1:N)'; i(:)], [-c.*sum(W, 2); (c(i).*W)(:)], N, N);
end

% ------------------------------------------------------------------------------------------------------------- source

% What the nonlocal model adds up at distance r = delta z, times delta eta^delta(r): the integrand over 0 < z < 1.
function y = integrand(g, s, kernel, x, t, z)
  r = g.delta*z;
  u = s.u(x, t);
  nonlocal = strcmp(g.divergence, "nonlocal");
  y = 0;
  if g.model == 1
    side = 2*(s.c(x) > s.b(x)) - 1;
    at = x - side.*r;
    if nonlocal, of_b = s.b(at); else of_b = s.b(x); end
    y = side.*((s.c(x) - of_b).*u - (s.c(at) - s.b(at)).*s.u(at, t));
  else
    for side = [1, -1]
      middle = x + side*r/2;
      u_at = s.u(x + side*r, t);
      b = s.b(middle);
      flux = (s.c(middle) - b).*(u + u_at);
      if nonlocal, flux += 2*b.*u; end
      y += (side*flux - g.delta*g.mu*(u_at - u)./r)/2;
    end
  end
  y = y.*kernel.eta(z)/g.delta;
end

function f = nonlocal_source(g, s, kernel, rule, x, t)
  f = s.u_t(x, t) + s.b(x).*s.u_x(x, t);
  if strcmp(g.divergence, "local"), f += s.b_prime(x).*s.u(x, t); end
  tolerance = 1e-11;
  smallest = 1e-6;   % the integrand of the inverse kernel is 0/0 at z = 0; what is left out there is flat
  for p = 1:numel(kernel.pieces) - 1
    from = kernel.pieces(p);
    to = kernel.pieces(p + 1);
    switch rule.name
      case "gauss"
        z = from + (to - from)*rule.node;
        f += (to - from)*(integrand(g, s, kernel, x, t, z)*rule.weight);
      case "integral"
        if from == 0
          f += smallest*integrand(g, s, kernel, x, t, smallest/2);
          from = smallest;
        end
        f += integral(@(z) integrand(g, s, kernel, x, t, z), from, to, "ArrayValued", true, "AbsTol", tolerance);
      case "quadgk"
        for j = 1:numel(x)
          f(j) += quadgk(@(z) integrand(g, s, kernel, x(j), t, z), from, to, "AbsTol", tolerance, "RelTol", tolerance);
        end
    end
  end
end

% Gauss-Legendre nodes (a row) and weights (a column) on (0, 1), by eigenvalues (Golub and Welsch).
function rule = gauss_rule(points)
  k = 1:points-1;
  off = k./sqrt(4*k.^2 - 1);
  [V, nodes] = eig(diag(off, 1) + diag(off, -1));
  rule.node = (diag(nodes)' + 1)/2;
  rule.weight = V(1, :)'.^2;
end

% ---------------------------------------------------------------------------------------------------------- time loop

% The max-norm error at T, after equal steps of forward Euler.
function e = run_case(g, rule)
  s = scene_of(g.scene);
  kernel = kernel_of(g.kernel);
  x0 = (0:g.N-1)'*(s.period/g.N);
  x = x0;
  u = s.u(x, 0);
  dt = s.T/g.steps;
  if s.standing, R = standing_rate(g, s, kernel, x); end
  for n = 0:g.steps-1
    t = n*dt;
    if strcmp(g.source, "local")
      f = s.u_t(x, t) + s.c(x).*s.u_x(x, t) + s.c_prime(x).*s.u(x, t);
    else
      f = nonlocal_source(g, s, kernel, rule, x, t);
    end
    if s.standing
      u += dt*(R*u + f);
    else
      if g.model == 1
        u += dt*(model1_rate(g, s, kernel, x, u) + f);
      else
        u += dt*(model2_rate(g, s, kernel, x, u) + f);
      end
      x = s.flow(x0, (n + 1)*dt);
    end
  end
  e = max(abs(u - s.u(x, s.T)));
end

arguments = argv();
cases = jsondecode(fileread(arguments{1}));
if isstruct(cases), cases = num2cell(cases); end
rule = gauss_rule(10);   % per smooth piece of the kernel: round-off at a horizon of 0.2
rule.name = arguments{3};
file = fopen(arguments{2}, "w");
for m = 1:numel(cases)
  started = tic();
  e = run_case(cases{m}, rule);
  if m == 1, before = "["; else before = ","; end
  if isfinite(e), e = sprintf("%.17g", e); else e = "null"; end
  fprintf(file, "%s{\"error_linf\": %s, \"seconds\": %.9g}", before, e, toc(started));
end
fprintf(file, "]\n");
fclose(file);
